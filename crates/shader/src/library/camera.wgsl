// A half-line with a unit direction.
struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

// The ray through a point of the picture, in pixels from its upper left corner.
fn camera_ray(raster: vec2<f32>) -> Ray {
    let aspect: f32 = view.size.x / view.size.y;
    let half_height: f32 = parameters[HALF] / select(1.0, aspect, parameters[IS_HORIZONTAL] > 0.0);
    let x: f32 = (2.0 * raster.x / view.size.x - 1.0) * half_height * aspect;
    let y: f32 = (1.0 - 2.0 * raster.y / view.size.y) * half_height;
    let offset: vec3<f32> = x * triple(RIGHT) + y * triple(UP);
    if (parameters[IS_PERSPECTIVE] > 0.0) {
        return Ray(triple(EYE), normalize(triple(FORWARD) + offset));
    }
    return Ray(triple(EYE) + offset, triple(FORWARD));
}

// The width of the cone around a ray at a distance from the camera.
fn width_at(t: f32) -> f32 {
    return parameters[FOOTPRINT] + parameters[FOOTPRINT + 1] * t;
}

// How far from a surface a ray may stop at a distance from the camera and another one from the origin.
fn tolerance_at(t: f32, offset: f32) -> f32 {
    let straight: f32 = parameters[TOLERANCE] + parameters[TOLERANCE + 1] * t + ROUNDING * offset;
    if (parameters[TOLERANCE + 2] == 0.0) {
        return straight;
    }
    return straight + parameters[TOLERANCE + 2] * power(t, parameters[TOLERANCE + 3]);
}

// The part of a ray inside the box around all that is marched; nothing if the end comes before the beginning.
fn clip(ray: Ray) -> vec2<f32> {
    let a: vec3<f32> = (triple(BOUNDS) - ray.origin) * inverse_of(ray.direction);
    let b: vec3<f32> = (triple(BOUNDS + 3) - ray.origin) * inverse_of(ray.direction);
    let near: vec3<f32> = min(a, b);
    let far: vec3<f32> = max(a, b);
    return vec2<f32>(max(max(max(near.x, near.y), near.z), 0.0), min(min(far.x, far.y), far.z));
}

// Reciprocals of coordinates, with a large number for that of 0.
fn inverse_of(v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(1.0 / away_from_zero(v.x), 1.0 / away_from_zero(v.y), 1.0 / away_from_zero(v.z));
}

fn away_from_zero(x: f32) -> f32 {
    return select(select(1e-20, -1e-20, x < 0.0), x, abs(x) > 1e-20);
}
