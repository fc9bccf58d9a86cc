// The first part that a ray meets before it ends.
fn first_met(ray: Ray, end: f32) -> March {
    let span: vec2<f32> = clip(ray);
    return march(ray, span.x, min(span.y, end), 0);
}

// What the parts leave of a light along a ray.
fn light_past(ray: Ray, end: f32, shade_of: Shade) -> f32 {
    var span: vec2<f32> = clip(ray);
    if (shade_of.is_soft) {
        let half: vec3<f32> = 0.5 * (triple(BOUNDS + 3) - triple(BOUNDS));
        span = penumbra(ray, triple(BOUNDS) + half, length(half), shade_of.sharpness * parameters[SCALE]);
    }
    return light_along(ray, span.x, min(span.y, end), shade_of, 0);
}
