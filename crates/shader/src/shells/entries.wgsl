
@group(0) @binding(2) var<storage, read_write> output: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> results: array<vec4<f32>>;

// One sample for each pixel of a tile, row by row.
@compute @workgroup_size(8, 8)
fn render(@builtin(global_invocation_id) id: vec3<u32>) {
    let column = i32(id.x);
    let row = i32(id.y);
    if column >= view.columns || row >= view.rows {
        return;
    }
    let raster = view.tile + vec2<f32>(f32(column), f32(row)) + view.place;
    let index = row * view.columns + column;
    var sum = view.weight * sample_along(camera_ray(raster));
    if view.keep != 0.0 {
        sum += view.keep * output[index];
    }
    output[index] = sum;
}

// The gradient of the whole field and its value at points, which are relative to the origin.
@compute @workgroup_size(64)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&points) && id.x < arrayLength(&results) {
        results[id.x] = field_gradient(points[id.x].xyz);
    }
}

// A triangle that covers the picture.
@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// What a display shows, in sRGB.
@fragment
fn show(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let raster = view.tile + floor(position.xy) + view.place;
    return vec4<f32>(shown_along(camera_ray(raster)), 1.0);
}
