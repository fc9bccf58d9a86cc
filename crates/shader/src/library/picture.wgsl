// What is shown: see `View` of the library.
const SHOW_LIT: i32 = 0;
const SHOW_NORMALS: i32 = 1;
const SHOW_STEPS: i32 = 2;
const SHOW_DEPTH: i32 = 3;
const SHOW_OBJECTS: i32 = 4;
const LAYER_NORMAL: i32 = 16;
const LAYER_NUMBERS: i32 = 17;

// The distance of a hit from the eye's plane.
fn depth_of(hit: Hit) -> f32 {
    return hit.distance * dot(-hit.viewer, triple(FORWARD));
}

// The linear colour that a ray sees, or one of the numbers behind it.
fn sample_along(ray: Ray) -> vec4<f32> {
    let hit: Hit = trace(ray);
    let has_met: bool = hit.part >= 0;
    if (view.show == SHOW_LIT) {
        let given_up: f32 = select(0.0, 1.0, hit.is_unresolved);
        if (hit.is_unresolved && parameters[WARNING] > 0.0) {
            return vec4<f32>(triple(WARNING + 1), given_up);
        }
        if (has_met) {
            return vec4<f32>(shade(hit), given_up);
        }
        return vec4<f32>(seen_behind(ray), given_up);
    }
    if (view.show == LAYER_NORMAL) {
        return vec4<f32>(hit.normal, select(-1.0, hit.distance, has_met));
    }
    var object: f32 = -1.0;
    if (has_met) {
        object = surface_at(hit.part, spot_of(hit)).object;
    }
    if (view.show == LAYER_NUMBERS) {
        let depth: f32 = select(-1.0, depth_of(hit), has_met);
        return vec4<f32>(depth, object, f32(hit.steps), select(0.0, 1.0, hit.is_unresolved));
    }
    if (view.show == SHOW_STEPS) {
        return vec4<f32>(heat(f32(hit.steps) / 64.0), 1.0);
    }
    if (!has_met) {
        return vec4<f32>(0.0);
    }
    if (view.show == SHOW_NORMALS) {
        return vec4<f32>(0.5 + 0.5 * hit.normal.x, 0.5 + 0.5 * hit.normal.y, 0.5 + 0.5 * hit.normal.z, 1.0);
    }
    if (view.show == SHOW_OBJECTS) {
        let hue: f32 = fract(0.381966 * object);
        return vec4<f32>(heat(hue), 1.0);
    }
    let near: f32 = parameters[SCENE_SIZE] / (parameters[SCENE_SIZE] + depth_of(hit));
    return vec4<f32>(near, near, near, 1.0);
}

// From black over blue, red and yellow to white.
fn heat(x: f32) -> vec3<f32> {
    let t: f32 = 4.0 * clamp(x, 0.0, 1.0);
    return vec3<f32>(
        clamp(t - 1.0, 0.0, 1.0),
        clamp(t - 2.0, 0.0, 1.0),
        clamp(t, 0.0, 1.0) - clamp(t - 1.0, 0.0, 1.0) + clamp(t - 3.0, 0.0, 1.0)
    );
}

// From scene light to the range of a display, in sRGB.
fn encoded(light: vec3<f32>) -> vec3<f32> {
    var color: vec3<f32> = light * parameters[GAIN];
    let brightest: f32 = max(max(color.x, color.y), color.z);
    if (parameters[SCALES_DOWN] > 0.0 && brightest > 1.0) {
        color = color / brightest;
    }
    return vec3<f32>(srgb(color.x), srgb(color.y), srgb(color.z));
}

fn srgb(channel: f32) -> f32 {
    let x: f32 = clamp(channel, 0.0, 1.0);
    return select(1.055 * pow(x, 0.41666666) - 0.055, 12.92 * x, x <= 0.0031308);
}

// What a display shows where a ray leads to.
fn shown_along(ray: Ray) -> vec3<f32> {
    let value: vec4<f32> = sample_along(ray);
    if (view.show == SHOW_LIT) {
        return encoded(value.xyz);
    }
    return value.xyz;
}
