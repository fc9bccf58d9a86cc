// How far the nearest surface seems to be. Warped distances are divided by their slope there, since safe steps are much shorter;
// formulas have no scale, so that they dim all or nothing.
fn seen_clearance(near: vec2<f32>, p: vec3<f32>) -> f32 {
    let safe: f32 = near.x * parameters[SCALE];
    if (FORMULA_COUNT == 0 || near.y == -1.0) {
        return safe;
    }
    let part: i32 = select(i32(near.y), -2 - i32(near.y), near.y < 0.0);
    let metric: f32 = parameters[PARTS + PART_SIZE * part + 10];
    if (metric == 0.0) {
        return safe;
    }
    if (metric == 2.0) {
        return FAR;
    }
    let value: vec4<f32> = part_gradient(part, p);
    return max(safe, value.w / max(length(value.xyz), 1e-30));
}

// How far surfaces may be from where they seem to be: formulas are exact.
fn blur() -> f32 {
    return 0.0;
}
