
@group(0) @binding(2) var picture: texture_storage_2d<rgba32float, write>;

// What a display shows, pixel by pixel; rows count from the bottom.
@compute @workgroup_size(8, 8)
fn render(@builtin(global_invocation_id) id: vec3<u32>) {
    if f32(id.x) >= view.size.x || f32(id.y) >= view.size.y {
        return;
    }
    let raster = vec2<f32>(f32(id.x), view.size.y - 1.0 - f32(id.y)) + view.place;
    textureStore(picture, vec2<u32>(id.x, id.y), vec4<f32>(shown_along(camera_ray(raster)), 1.0));
}

// The value and the gradient of the field, kept for other kernels.
@compute @workgroup_size(1)
fn measure() {
    textureStore(picture, vec2<u32>(0u, 0u), field_gradient(triple(0)));
}
