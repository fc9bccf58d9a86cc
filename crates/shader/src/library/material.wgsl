// The cosine between normal and view that footprints are stretched by at most.
const GRAZING: f32 = 0.001;

// How far from the surface a pattern in space is looked up, in cells.
const PATTERN_SHIFT: f32 = 0.0001;

// A point of a surface, and the part of the surface that a ray stands for there.
struct Spot {
    position: vec3<f32>,
    normal: vec3<f32>,
    viewer: vec3<f32>,
    width: f32,
    uncertainty: f32,
}

// What a surface looks like at a point; a sum of several of them until it is `settled`.
struct Surface {
    color: vec3<f32>,
    emissive: vec3<f32>,
    // The shares of light sent back: ambient, diffuse, specular.
    shares: vec3<f32>,
    exponent: f32,
    // Whether highlights are those of Blinn's model, and the number of the object: those of the largest share.
    is_blinn: bool,
    object: f32,
    // The sum of all shares in it, and the largest one.
    total: f32,
    largest: f32,
}

// Nothing yet.
fn no_surface() -> Surface {
    return Surface(vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), 0.0, false, 0.0, 0.0, 0.0);
}

// A surface with a share of a material added, whose numbers begin at `first`.
fn with_share(so_far: Surface, share: f32, first: i32, spot: Spot) -> Surface {
    if (share <= 0.0) {
        return so_far;
    }
    var sum: Surface = so_far;
    let odd: f32 = odd_share(first, spot);
    sum.color += share * mix(triple(first), triple(first + 3), odd);
    sum.emissive += share * triple(first + 10);
    sum.shares += share * triple(first + 13);
    sum.exponent += share * parameters[first + 16];
    sum.total += share;
    if (share > sum.largest) {
        sum.largest = share;
        sum.is_blinn = parameters[first + 17] > 0.0;
        sum.object = parameters[first + 18];
    }
    return sum;
}

// The mean of all shares.
fn settled(sum: Surface) -> Surface {
    var mean: Surface = sum;
    let by: f32 = 1.0 / max(sum.total, 1e-30);
    mean.color *= by;
    mean.emissive *= by;
    mean.shares *= by;
    mean.exponent *= by;
    return mean;
}

// The extents along the axes of the ellipse that a ray's round cross-section leaves on the surface.
fn extents(spot: Spot) -> vec3<f32> {
    let cosine: f32 = dot(spot.normal, spot.viewer);
    let downhill: vec3<f32> = spot.viewer - cosine * spot.normal;
    let stretch: f32 = 1.0 / max(cosine * cosine, GRAZING * GRAZING);
    let in_plane: vec3<f32> = max(vec3<f32>(1.0) - spot.normal * spot.normal, vec3<f32>(0.0));
    return spot.width * sqrt(in_plane + downhill * downhill * stretch);
}

// The part of the odd cells of a checker pattern in a footprint: the product of three means of square waves.
fn odd_share(first: i32, spot: Spot) -> f32 {
    let size: f32 = parameters[first + 6];
    if (size <= 0.0) {
        return 0.0;
    }
    let shift: f32 = 2.0 * spot.uncertainty + PATTERN_SHIFT * size;
    let middle: vec3<f32> = (spot.position + spot.normal * shift) / size + triple(first + 7);
    let width: vec3<f32> = extents(spot) / size;
    return 0.5 - 0.5 * wave(middle.x, width.x) * wave(middle.y, width.y) * wave(middle.z, width.z);
}

// The mean of a square wave of period 2 over an interval.
fn wave(middle: f32, width: f32) -> f32 {
    if (width < PATTERN_SHIFT) {
        return 1.0 - 2.0 * modulo2(floor(middle));
    }
    return (wave_integral(middle + 0.5 * width) - wave_integral(middle - 0.5 * width)) / width;
}

fn wave_integral(x: f32) -> f32 {
    return 1.0 - abs(modulo2(x) - 1.0);
}

fn modulo2(x: f32) -> f32 {
    return x - 2.0 * floor(0.5 * x);
}
