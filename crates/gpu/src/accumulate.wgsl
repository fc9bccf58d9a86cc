// Adds one sample of each pixel of a tile to the sums of the picture; the first one replaces what was there.

struct Place {
    // Of the tile in the picture of sums.
    origin: vec2<u32>,
    size: vec2<u32>,
    // Of the picture of sums.
    width: u32,
    is_first: u32,
}

@group(0) @binding(0) var<uniform> place: Place;
@group(0) @binding(1) var<storage, read> tile: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> sums: array<vec4<f32>>;

@compute @workgroup_size(8, 8)
fn add(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= place.size) {
        return;
    }
    let color = tile[pixel.y * place.size.x + pixel.x];
    let at = place.origin + pixel.xy;
    let index = at.y * place.width + at.x;
    if place.is_first == 1u {
        sums[index] = color;
    } else {
        sums[index] += color;
    }
}
