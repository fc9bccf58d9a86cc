// Shadow rays start this many uncertainties above the surface, and hit what is nearer than so many tolerances.
const SHADOW_START: f32 = 2.0;
const SHADOW_HIT: f32 = 0.5;

// The shortest distance to a light that its intensity is divided by.
const NEAREST_LIGHT: f32 = 1e-6;

// A soft shadow darker than this is black.
const NEGLIGIBLE: f32 = 0.00012207031;

// The shortest step of a march for a soft shadow, in clearances.
const SHORTEST_STEP: f32 = 0.5;

// A ratio that has fallen by less than this on the last step will not fall much any more.
const STEADY: f32 = 0.98;

// The kinds of shadows.
const NO_SHADOW: f32 = 0.0;
const HARD_SHADOW: f32 = 1.0;
const SHARPNESS: f32 = 2.0;

// Light on its way to a point.
struct Incoming {
    direction: vec3<f32>,
    distance: f32,
    light: vec3<f32>,
}

// The light whose numbers begin at `first` as it arrives at a point if nothing stands in between.
fn incoming(first: i32, p: vec3<f32>) -> Incoming {
    let power_of: vec3<f32> = triple(first + 4);
    if (parameters[first] == 0.0) {
        return Incoming(triple(first + 1), FAR, power_of);
    }
    let way: vec3<f32> = triple(first + 1) - p;
    let distance: f32 = max(length(way), NEAREST_LIGHT);
    let direction: vec3<f32> = way / distance;
    let weakening: f32 = parameters[first + 7] + distance * (parameters[first + 8] + distance * parameters[first + 9]);
    var share: f32 = 1.0;
    if (parameters[first + 10] > 0.0) {
        let cosine: f32 = -dot(direction, triple(first + 11));
        if (cosine < parameters[first + 15]) {
            let outer: f32 = parameters[first + 14];
            let t: f32 = clamp((cosine - outer) / (parameters[first + 15] - outer), 0.0, 1.0);
            share = t * t * (3.0 - 2.0 * t);
        }
    }
    return Incoming(direction, distance, power_of * (share / max(weakening, 1e-12)));
}

// The light that leaves towards the viewer.
fn reflected(surface: Surface, hit: Hit, incoming_light: Incoming, n_dot_l: f32) -> vec3<f32> {
    var highlight: f32 = 0.0;
    if (surface.shares.z > 0.0) {
        var cosine: f32 = 0.0;
        if (surface.is_blinn) {
            let between: vec3<f32> = incoming_light.direction + hit.viewer;
            cosine = dot(hit.normal, between) / max(length(between), 1e-30);
        } else {
            cosine = dot(2.0 * n_dot_l * hit.normal - incoming_light.direction, hit.viewer);
        }
        if (cosine > 0.0) {
            highlight = surface.shares.z * pow(min(cosine, 1.0), surface.exponent);
        }
    }
    return incoming_light.light * (surface.shares.y * n_dot_l * surface.color + vec3<f32>(highlight));
}

// The part of a ray where a ball is nearer than the distance travelled over `sharpness`.
fn penumbra(ray: Ray, middle: vec3<f32>, radius: f32, sharpness: f32) -> vec2<f32> {
    let away: vec3<f32> = ray.origin - middle;
    let spread: f32 = 1.0 / sharpness;
    let a: f32 = 1.0 - spread * spread;
    if (radius > 1e12 || a <= 0.0) {
        return vec2<f32>(0.0, FAR);
    }
    let b: f32 = dot(away, ray.direction) - radius * spread;
    let c: f32 = dot(away, away) - radius * radius;
    let discriminant: f32 = b * b - a * c;
    if (discriminant < 0.0) {
        return vec2<f32>(0.0, -1.0);
    }
    let root: f32 = sqrt(discriminant);
    return vec2<f32>(max((-b - root) / a, 0.0), (-b + root) / a);
}

// What a shadow ray goes by.
struct Shade {
    // Whether nearness dims the light already, and the ratio of distance to clearance at which it begins to.
    is_soft: bool,
    sharpness: f32,
    // Field values that count as a hit: at the start, and how much more for each unit of length.
    base: f32,
    growth: f32,
}

// What is left of a light along a ray through what `reach_at` knows as `parts`.
fn light_along(ray: Ray, start: f32, end: f32, shade_of: Shade, parts: i32) -> f32 {
    var t: f32 = start;
    var factor: f32 = 1.0;
    var before: f32 = FAR;
    for (var steps: i32 = 0; steps < i32(parameters[MAX_STEPS]); steps++) {
        if (t >= end) {
            break;
        }
        let p: vec3<f32> = ray.origin + t * ray.direction;
        let near: vec2<f32> = reach_at(p, parts);
        let value: f32 = near.x;
        if (near.y >= 0.0 && value < shade_of.base * share_at(near.y) + shade_of.growth * t) {
            return 0.0;
        }
        var clearance: f32 = value * parameters[SCALE];
        if (!shade_of.is_soft && is_formula(near.y)) {
            clearance = max(clearance, free_at(p, ray.direction, parts));
        }
        var step_length: f32 = clearance;
        if (shade_of.is_soft) {
            let here: f32 = shade_of.sharpness * seen_clearance(near, p) / max(t, 1e-30);
            factor = min(factor, here);
            if (factor < NEGLIGIBLE) {
                return 0.0;
            }
            // Up to where clearance over distance could first fall below the least ratio so far.
            let ratio: f32 = factor / shade_of.sharpness;
            let safe: f32 = (clearance - t * ratio) / (1.0 + ratio);
            let short_step: f32 = select(clearance * SHORTEST_STEP, clearance, here >= before * STEADY);
            step_length = max(safe, short_step);
            before = here;
        }
        t += step_length * parameters[STEP_FACTOR];
    }
    // A ray that still creeps along a formula grazes it.
    if (FORMULA_COUNT > 0 && t < end) {
        return 0.0;
    }
    return factor;
}

// The part of a light that arrives at a hit.
fn shadow(first: i32, hit: Hit, incoming_light: Incoming) -> f32 {
    let kind: f32 = parameters[first + 16];
    if (kind == NO_SHADOW) {
        return 1.0;
    }
    let ray: Ray = Ray(hit.position + SHADOW_START * hit.uncertainty * hit.normal, incoming_light.direction);
    for (var i: i32 = 0; i < PLANE_COUNT; i++) {
        if (plane_hit(ray, PLANES + PLANE_SIZE * i) < min(incoming_light.distance, 0.5 * FAR)) {
            return 0.0;
        }
    }
    if (PART_COUNT == 0) {
        return 1.0;
    }
    var sharpness: f32 = parameters[first + 17];
    if (kind > SHARPNESS) {
        sharpness = incoming_light.distance / sharpness;
    }
    let base: f32 = (SHADOW_HIT * hit.tolerance + ROUNDING * length(ray.origin)) * hit.slope;
    let shade_of: Shade = Shade(kind >= SHARPNESS, sharpness, base, ROUNDING * hit.slope);
    return light_past(ray, min(parameters[MAX_DISTANCE], incoming_light.distance), shade_of);
}

// How far away the nearest surface seems to be from a point that need not be outside of all. What has no scale, or a warped one,
// is divided by its slope there, which is right to first order; without a slope nothing is known to be near. No more than `most`.
fn clearance(p: vec3<f32>, most: f32) -> f32 {
    // Values of formulas are no distances to be compared with.
    let near: vec2<f32> = unscaled(p, select(most, FAR, FORMULA_COUNT > 0));
    var free: f32 = near.x;
    if (FORMULA_COUNT > 0 && near.y >= 0.0) {
        if (parameters[PARTS + PART_SIZE * i32(near.y) + 10] > 0.0) {
            let value: vec4<f32> = part_gradient(i32(near.y), p);
            let steepness: f32 = length(value.xyz);
            free = select(FAR, max(value.w, 0.0) / max(steepness, 1e-30), steepness > 0.0);
        }
    }
    return nearest_plane(vec2<f32>(free, -1.0), p).x;
}

// The share of the ambient light that the surroundings of a hit leave.
fn openness(hit: Hit) -> f32 {
    var occluded: f32 = 0.0;
    for (var i: i32 = 0; i < 5; i++) {
        let weight: f32 = parameters[OCCLUSION + 5 + i];
        if (weight > 0.0) {
            let height: f32 = parameters[OCCLUSION + i];
            occluded += weight * max(height - clearance(hit.position + height * hit.normal, height), 0.0);
        }
    }
    return clamp(1.0 - occluded, 0.0, 1.0);
}

// What a ray sees that meets nothing.
fn seen_behind(ray: Ray) -> vec3<f32> {
    return mix(triple(BACKGROUND), triple(BACKGROUND + 3), 0.5 + 0.5 * ray.direction.z);
}

// The part of the surface that a ray stands for where it hits.
fn spot_of(hit: Hit) -> Spot {
    return Spot(hit.position, hit.normal, hit.viewer, width_at(hit.distance), hit.uncertainty);
}

// The linear colour that a ray sees which met something.
fn shade(hit: Hit) -> vec3<f32> {
    let surface: Surface = surface_at(hit.part, spot_of(hit));
    let around: vec3<f32> = mix(triple(AMBIENT), triple(AMBIENT + 3), 0.5 + 0.5 * hit.normal.z);
    var color: vec3<f32> = surface.emissive;
    if (surface.shares.x > 0.0) {
        color += surface.shares.x * openness(hit) * surface.color * around;
    }
    if (surface.shares.y > 0.0 || surface.shares.z > 0.0) {
        for (var i: i32 = 0; i < i32(parameters[LIGHT_COUNT]); i++) {
            let first: i32 = LIGHTS + LIGHT_SIZE * i;
            let light: Incoming = incoming(first, hit.position);
            let n_dot_l: f32 = dot(hit.normal, light.direction);
            if (n_dot_l > 0.0 && light.light.x + light.light.y + light.light.z > 0.0) {
                color += shadow(first, hit, light) * reflected(surface, hit, light, n_dot_l);
            }
        }
    }
    return color;
}
