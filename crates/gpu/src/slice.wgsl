
// The field on the plane that faces the eye at a distance, which the view's weight holds: warm outside, cool inside, with
// lines at a power of ten that fits the picture, and a bright line at the surface.
@compute @workgroup_size(8, 8)
fn slice(@builtin(global_invocation_id) id: vec3<u32>) {
    let column = i32(id.x);
    let row = i32(id.y);
    if column >= view.columns || row >= view.rows {
        return;
    }
    let ray = camera_ray(view.tile + vec2<f32>(f32(column), f32(row)) + view.place);
    let to_plane = view.weight - dot(ray.origin - triple(EYE), triple(FORWARD));
    let point = ray.origin + ray.direction * (to_plane / dot(ray.direction, triple(FORWARD)));
    let gradient = field_gradient(point);
    let value = gradient.w;
    // The largest power of ten that is no more than a twentieth of the distance; 0.30103 is the logarithm of 2.
    let spacing = pow(10.0, floor(log2(view.weight / 20.0) * 0.30103));
    let width = pixel_width(view.weight) * max(length(gradient.xyz), 1e-6);
    let shade = 0.75 + 0.2 * exp(-abs(value) / (4.0 * spacing));
    var color = select(vec3(0.45, 0.62, 0.85), vec3(0.9, 0.72, 0.5), value > 0.0) * shade;
    let phase = abs(fract(value / spacing - 0.5) - 0.5) * spacing;
    color *= 1.0 - 0.5 * clamp(1.5 - phase / width, 0.0, 1.0);
    color = mix(color, vec3(1.0), clamp(2.5 - abs(value) / width, 0.0, 1.0));
    output[row * view.columns + column] = vec4(color, 1.0);
}

// The width of a pixel at a distance in front of the eye.
fn pixel_width(depth: f32) -> f32 {
    let footprint = parameter(FOOTPRINT) + parameter(FOOTPRINT + 1) * depth;
    return max(footprint, 1e-9);
}
