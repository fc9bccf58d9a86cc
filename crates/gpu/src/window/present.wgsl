// From sums of samples to the window: the finer picture where there is one, else the coarse one enlarged; exposure,
// what is brighter than white, sRGB; and a panel of text in the upper left corner.

struct Screen {
    size: vec2<u32>,
    coarse: vec2<u32>,
    panel: vec2<u32>,
    // Samples that all pixels of the finer picture have.
    samples: u32,
    // One more is in all rows above this one,
    rows: u32,
    // and in some columns of some rows from there.
    band: u32,
    columns: u32,
    // What light is multiplied with; 0 for pictures that are no light and shown as they are.
    gain: f32,
    // Whether overbright pixels keep their hue.
    is_scaled_down: u32,
    // Whether the window itself encodes linear colours as sRGB.
    is_encoded_later: u32,
}

@group(0) @binding(0) var<uniform> screen: Screen;
@group(0) @binding(1) var<storage, read> coarse: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> fine: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> panel: array<u32>;

// One triangle that covers the window.
@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let x = f32(i32(index & 1u) * 4 - 1);
    let y = f32(i32(index & 2u) * 2 - 1);
    return vec4(x, y, 0.0, 1.0);
}

@fragment
fn color(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = min(vec2<u32>(position.xy), screen.size - 1u);
    var shown = picture(pixel);
    if screen.gain > 0.0 {
        shown = encoded(toned(shown));
    }
    shown = clamp(shown, vec3(0.0), vec3(1.0));
    if all(pixel < screen.panel) {
        let letter = unpack4x8unorm(panel[pixel.y * screen.panel.x + pixel.x]);
        shown = mix(shown, letter.rgb, letter.a);
    }
    if screen.is_encoded_later == 1u {
        shown = decoded(shown);
    }
    return vec4(shown, 1.0);
}

fn picture(pixel: vec2<u32>) -> vec3<f32> {
    let is_ahead = pixel.y < screen.rows || (pixel.y < screen.rows + screen.band && pixel.x < screen.columns);
    let samples = screen.samples + select(0u, 1u, is_ahead);
    if samples > 0u {
        return fine[pixel.y * screen.size.x + pixel.x].rgb / f32(samples);
    }
    // Between the centres of the four nearest pixels.
    let last = vec2<f32>(screen.coarse - 1u);
    let place = (vec2<f32>(pixel) + 0.5) / vec2<f32>(screen.size) * vec2<f32>(screen.coarse) - 0.5;
    let near = clamp(place, vec2(0.0), last);
    let low = vec2<u32>(near);
    let high = min(low + 1u, screen.coarse - 1u);
    let part = fract(near);
    let upper = mix(coarse_at(low), coarse_at(vec2(high.x, low.y)), part.x);
    let lower = mix(coarse_at(vec2(low.x, high.y)), coarse_at(high), part.x);
    return mix(upper, lower, part.y);
}

fn coarse_at(pixel: vec2<u32>) -> vec3<f32> {
    return coarse[pixel.y * screen.coarse.x + pixel.x].rgb;
}

fn toned(light: vec3<f32>) -> vec3<f32> {
    let bright = light * screen.gain;
    let most = max(bright.r, max(bright.g, bright.b));
    if screen.is_scaled_down == 1u && most > 1.0 {
        return bright / most;
    }
    return clamp(bright, vec3(0.0), vec3(1.0));
}

fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let curve = 1.055 * pow(max(linear, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055;
    return select(curve, 12.92 * linear, linear <= vec3(0.0031308));
}

fn decoded(code: vec3<f32>) -> vec3<f32> {
    let curve = pow((code + 0.055) / 1.055, vec3(2.4));
    return select(curve, code / 12.92, code <= vec3(0.04045));
}
