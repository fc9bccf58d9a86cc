// How far a ray may go from a point before it meets one of all parts, and which one: see `nearest`.
fn reach_at(p: vec3<f32>, parts: i32) -> vec2<f32> {
    return nearest(p, FAR);
}

// How far a ray may go from a point in a direction.
fn free_at(p: vec3<f32>, direction: vec3<f32>, parts: i32) -> f32 {
    return free_ahead(p, direction);
}
