// A scene of distance fields, made into a shader by Freikugel.

// What is to be computed.
struct View {
    // The size of the whole picture in pixels, and the upper left pixel of the tile.
    size: vec2<f32>,
    tile: vec2<f32>,
    // Where in its pixel the sample lies, from 0 to 1.
    place: vec2<f32>,
    // Seconds since the start.
    time: f32,
    // What is shown.
    show: i32,
    // Columns and rows of the tile.
    columns: i32,
    rows: i32,
    // What the output keeps of what it holds, and the weight of what is added.
    keep: f32,
    weight: f32,
}

@group(0) @binding(1) var<uniform> view: View;

// All numbers of the scene: changing them changes nothing else.

