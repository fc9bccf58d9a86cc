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

@group(0) @binding(0) var<uniform> parameters: array<vec4<f32>, 132>;

fn parameter(place: i32) -> f32 {
    return parameters[place >> 2u][place & 3];
}

fn quad(place: i32) -> vec4<f32> {
    return parameters[place >> 2u];
}

// Places in the table of parameters, and counts.
const EYE: i32 = 0;
const RIGHT: i32 = 3;
const UP: i32 = 6;
const FORWARD: i32 = 9;
const TARGET: i32 = 12;
const HALF: i32 = 15;
const IS_HORIZONTAL: i32 = 16;
const IS_PERSPECTIVE: i32 = 17;
const FOOTPRINT: i32 = 18;
const TOLERANCE: i32 = 20;
const SCALE: i32 = 24;
const STEP_FACTOR: i32 = 25;
const MAX_STEPS: i32 = 26;
const MAX_DISTANCE: i32 = 27;
const BOUNDS: i32 = 28;
const AMBIENT: i32 = 34;
const BACKGROUND: i32 = 40;
const OCCLUSION: i32 = 46;
const GAIN: i32 = 56;
const SCALES_DOWN: i32 = 57;
const WARNING: i32 = 58;
const SCENE_SIZE: i32 = 62;
const LIGHT_COUNT: i32 = 63;
const PARTS: i32 = 64;
const PART_SIZE: i32 = 12;
const PART_COUNT: i32 = 3;
const FORMULA_COUNT: i32 = 0;
const PLANES: i32 = 100;
const PLANE_SIZE: i32 = 6;
const PLANE_COUNT: i32 = 1;
const REGIONS: i32 = 106;
const REGION_SIZE: i32 = 21;
const LIGHTS: i32 = 456;
const LIGHT_SIZE: i32 = 18;
// Farther than anything.
const FAR: f32 = 1e30;
// Rounding errors of a field value, relative to the coordinates.
const ROUNDING: f32 = 4.7683716e-7;

// A half-line with a unit direction.
struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

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
    shares: vec3<f32>,
    exponent: f32,
    is_blinn: bool,
    object: f32,
    total: f32,
    largest: f32,
}

// A hit is a false one if by its gradient the surface is still this many tolerances away.
const FALSE_HIT: f32 = 2.0;
// The least gradient a surface is expected to have.
const FLATTEST: f32 = 0.001;
// A ray that ran out of steps shows the surface it is creeping along if that is nearer than this many tolerances.
const CREEPING: f32 = 64.0;
// How much farther than the free distance a step goes at first; it is taken back where it might have passed a surface.
const RELAXATION: f32 = 1.2;
// How often a march goes on after a false hit.
const MOST_MARCHES: i32 = 16;
// The share of the tolerance that is used at formulas, whose zeros the processor finds exactly.
const FORMULA_SHARE: f32 = 0.0625;

// What a ray met.
struct Hit {
    distance: f32,
    part: i32,
    steps: i32,
    is_unresolved: bool,
    position: vec3<f32>,
    normal: vec3<f32>,
    viewer: vec3<f32>,
    uncertainty: f32,
    tolerance: f32,
    slope: f32,
}

// What a march along a ray came to.
struct March {
    distance: f32,
    part: i32,
    steps: i32,
    is_unresolved: bool,
    gradient: vec4<f32>,
}

// Shadow rays start this many uncertainties above the surface, and hit what is nearer than so many tolerances.
const SHADOW_START: f32 = 2.0;
const SHADOW_HIT: f32 = 0.5;
// The shortest distance to a light that its intensity is divided by.
const NEAREST_LIGHT: f32 = 1e-6;
// A soft shadow darker than this is black.
const NEGLIGIBLE: f32 = 0.00012207031;
// The shortest step of a march for a soft shadow, in clearances.
const SHORTEST_STEP: f32 = 0.5;
// A ratio that has fallen by less than this on the last step will not fall much any more.
const STEADY: f32 = 0.98;
// The kinds of shadows.
const NO_SHADOW: f32 = 0.0;
const SHARPNESS: f32 = 2.0;

// Light on its way to a point.
struct Incoming {
    direction: vec3<f32>,
    distance: f32,
    light: vec3<f32>,
}

// What a shadow ray goes by.
struct Shade {
    is_soft: bool,
    sharpness: f32,
    base: f32,
    growth: f32,
}

// What is shown: see `View` of the library.
const SHOW_LIT: i32 = 0;
const SHOW_NORMALS: i32 = 1;
const SHOW_STEPS: i32 = 2;
const SHOW_OBJECTS: i32 = 4;
const LAYER_NORMAL: i32 = 16;
const LAYER_NUMBERS: i32 = 17;

// Three parameters as a vector.
fn triple(first: i32) -> vec3<f32> {
    return vec3<f32>(parameter(first), parameter(first + 1), parameter(first + 2));
}

// The power of a number that may be negative, if the exponent is whole.
fn power(base: f32, exponent: f32) -> f32 {
    if exponent == 0.0 {
        return 1.0;
    }
    let positive = pow(abs(base), exponent);
    if base < 0.0 && fract(0.5 * exponent) != 0.0 {
        return -positive;
    }
    return positive;
}

// A value and the part it belongs to: the nearer of one so far and another.
fn closer(so_far: vec2<f32>, value: f32, part: f32) -> vec2<f32> {
    return select(so_far, vec2<f32>(value, part), value < so_far.x);
}

// The lesser of two values, each after its gradient.
fn nearer(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    return select(b, a, a.w < b.w);
}

// The distance from a box, given by its middle and half its edges; 0 inside.
fn apart(p: vec3<f32>, first: i32) -> f32 {
    return length(max(abs(p - triple(first)) - triple(first + 3), vec3<f32>(0.0)));
}

// The ray through a point of the picture, in pixels from its upper left corner.
fn camera_ray(raster: vec2<f32>) -> Ray {
    let aspect = view.size.x / view.size.y;
    let half_height = parameter(HALF) / select(1.0, aspect, parameter(IS_HORIZONTAL) > 0.0);
    let x = (2.0 * raster.x / view.size.x - 1.0) * half_height * aspect;
    let y = (1.0 - 2.0 * raster.y / view.size.y) * half_height;
    let offset = x * triple(RIGHT) + y * triple(UP);
    if parameter(IS_PERSPECTIVE) > 0.0 {
        return Ray(triple(EYE), normalize(triple(FORWARD) + offset));
    }
    return Ray(triple(EYE) + offset, triple(FORWARD));
}

// The width of the cone around a ray at a distance from the camera.
fn width_at(t: f32) -> f32 {
    return parameter(FOOTPRINT) + parameter(FOOTPRINT + 1) * t;
}

// How far from a surface a ray may stop at a distance from the camera and another one from the origin.
fn tolerance_at(t: f32, offset: f32) -> f32 {
    let straight = parameter(TOLERANCE) + parameter(TOLERANCE + 1) * t + ROUNDING * offset;
    if parameter(TOLERANCE + 2) == 0.0 {
        return straight;
    }
    return straight + parameter(TOLERANCE + 2) * power(t, parameter(TOLERANCE + 3));
}

fn away_from_zero(x: f32) -> f32 {
    return select(select(1e-20, -1e-20, x < 0.0), x, abs(x) > 1e-20);
}

// Reciprocals of coordinates, with a large number for that of 0.
fn inverse_of(v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(1.0 / away_from_zero(v.x), 1.0 / away_from_zero(v.y), 1.0 / away_from_zero(v.z));
}

// The part of a ray inside the box around all that is marched; nothing if the end comes before the beginning.
fn clip(ray: Ray) -> vec2<f32> {
    let a = (triple(BOUNDS) - ray.origin) * inverse_of(ray.direction);
    let b = (triple(BOUNDS + 3) - ray.origin) * inverse_of(ray.direction);
    let near = min(a, b);
    let far = max(a, b);
    return vec2<f32>(max(max(max(near.x, near.y), near.z), 0.0), min(min(far.x, far.y), far.z));
}

// Nothing yet.
fn no_surface() -> Surface {
    return Surface(vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), 0.0, false, 0.0, 0.0, 0.0);
}

// The extents along the axes of the ellipse that a ray's round cross-section leaves on the surface.
fn extents(spot: Spot) -> vec3<f32> {
    let cosine = dot(spot.normal, spot.viewer);
    let downhill = spot.viewer - cosine * spot.normal;
    let stretch = 1.0 / max(cosine * cosine, GRAZING * GRAZING);
    let in_plane = max(vec3<f32>(1.0) - spot.normal * spot.normal, vec3<f32>(0.0));
    return spot.width * sqrt(in_plane + downhill * downhill * stretch);
}

fn modulo2(x: f32) -> f32 {
    return x - 2.0 * floor(0.5 * x);
}

fn wave_integral(x: f32) -> f32 {
    return 1.0 - abs(modulo2(x) - 1.0);
}

// The mean of a square wave of period 2 over an interval.
fn wave(middle: f32, width: f32) -> f32 {
    if width < PATTERN_SHIFT {
        return 1.0 - 2.0 * modulo2(floor(middle));
    }
    return (wave_integral(middle + 0.5 * width) - wave_integral(middle - 0.5 * width)) / width;
}

// The part of the odd cells of a checker pattern in a footprint: the product of three means of square waves.
fn odd_share(first: i32, spot: Spot) -> f32 {
    let size = parameter(first + 6);
    if size <= 0.0 {
        return 0.0;
    }
    let shift = 2.0 * spot.uncertainty + PATTERN_SHIFT * size;
    let middle = (spot.position + spot.normal * shift) / size + triple(first + 7);
    let width = extents(spot) / size;
    return 0.5 - 0.5 * wave(middle.x, width.x) * wave(middle.y, width.y) * wave(middle.z, width.z);
}

// A surface with a share of a material added, whose numbers begin at `first`.
fn with_share(so_far: Surface, share: f32, first: i32, spot: Spot) -> Surface {
    if share <= 0.0 {
        return so_far;
    }
    var sum: Surface = so_far;
    let odd = odd_share(first, spot);
    sum.color = sum.color + share * mix(triple(first), triple(first + 3), odd);
    sum.emissive = sum.emissive + share * triple(first + 10);
    sum.shares = sum.shares + share * triple(first + 13);
    sum.exponent = sum.exponent + share * parameter(first + 16);
    sum.total = sum.total + share;
    if share > sum.largest {
        sum.largest = share;
        sum.is_blinn = parameter(first + 17) > 0.0;
        sum.object = parameter(first + 18);
    }
    return sum;
}

// The mean of all shares.
fn settled(sum: Surface) -> Surface {
    var mean: Surface = sum;
    let by = 1.0 / max(sum.total, 1e-30);
    mean.color = mean.color * by;
    mean.emissive = mean.emissive * by;
    mean.shares = mean.shares * by;
    mean.exponent = mean.exponent * by;
    return mean;
}

// The share of the tolerance that is used at a part.
fn share_at(part: f32) -> f32 {
    if FORMULA_COUNT == 0 || part < 0.0 {
        return 1.0;
    }
    return select(1.0, FORMULA_SHARE, parameter(PARTS + PART_SIZE * i32(part) + 10) == 2.0);
}

// Where a ray meets a plane that objects end at: a half-space, or a sheet; FAR if it does not.
fn plane_hit(ray: Ray, first: i32) -> f32 {
    let height = dot(triple(first), ray.origin) - parameter(first + 3);
    let descent = -dot(triple(first), ray.direction);
    if parameter(first + 4) > 0.0 {
        let t = height / away_from_zero(descent);
        return select(FAR, t, t >= 0.0 && abs(descent) > 1e-20);
    }
    if height <= 0.0 {
        return 0.0;
    }
    return select(FAR, height / away_from_zero(descent), descent > 1e-20);
}

// The value of a plane's object, and the plane's number.
fn plane_value(p: vec3<f32>, first: i32) -> f32 {
    let height = (dot(triple(first), p) - parameter(first + 3)) * parameter(first + 5);
    return select(height, abs(height), parameter(first + 4) > 0.0);
}

// The plane nearest to a point, if it is nearer than what is so far.
fn nearest_plane(so_far: vec2<f32>, p: vec3<f32>) -> vec2<f32> {
    var d: vec2<f32> = so_far;
    for (var i: i32 = 0; i < PLANE_COUNT; i++) {
        d = closer(d, plane_value(p, PLANES + PLANE_SIZE * i), f32(PART_COUNT + i));
    }
    return d;
}

// Whether two numbered parts are seen from both sides.
fn is_sheet(part: i32) -> bool {
    return parameter(REGIONS + REGION_SIZE * part + 20) > 0.0;
}

fn facing(normal: vec3<f32>, viewer: vec3<f32>, part: i32) -> vec3<f32> {
    return select(normal, -normal, is_sheet(part) && dot(normal, viewer) < 0.0);
}

// Whether what is nearest to a point is a formula.
fn is_formula(part: f32) -> bool {
    if FORMULA_COUNT == 0 || part < 0.0 {
        return false;
    }
    return parameter(PARTS + PART_SIZE * i32(part) + 10) > 0.0;
}

// A box with its middle at the origin.
fn box(p: vec3<f32>, c0: f32, c1: f32, c2: f32, round_2: f32) -> f32 {
    let t1 = abs(p.x) - c0;
    let t2 = abs(p.y) - c1;
    let t3 = abs(p.z) - c2;
    return length(vec3<f32>(max(t1, 0.0), max(t2, 0.0), max(t3, 0.0))) + min(max(max(t1, t2), t3), 0.0) - round_2;
}

// A cone or frustum with flat ends, its middle at the origin.
fn cone(p: vec3<f32>, bottom: f32, top: f32, half_height: f32, c3: f32, c4: f32, c5: f32) -> f32 {
    let t1 = length(p.xy);
    let t2 = t1 - bottom;
    let t3 = p.z + half_height;
    let t4 = t2 * c3 + t3 * c4;
    let t5 = (t3 * c3 - t2 * c4) * c5;
    let t6 = abs(p.z) - half_height;
    let t7 = min(length(vec2<f32>(t2, t3)), length(vec2<f32>(t1 - top, p.z - half_height)));
    return select(min(select(t7, abs(t4), 0.0 < t5 && t5 < 1.0), select(t7, abs(t6), t1 < select(top, bottom, p.z < 0.0))), max(t4, t6), t4 < 0.0 && t6 < 0.0);
}

// A ring: a tube around a circle.
fn torus(p: vec3<f32>, major: f32, minor: f32) -> f32 {
    return length(vec2<f32>(length(p.xy) - major, p.z)) - minor;
}

fn smooth_union(a: f32, b: f32, k: f32, c1: f32, c2: f32, c3: f32) -> f32 {
    let t1 = max(k - abs(a - b), 0.0) * c1;
    return min(a, b) - t1 * t1 * (c2 + c3 * t1);
}

// A ball around the origin.
fn sphere(p: vec3<f32>, radius: f32) -> f32 {
    return length(p) - radius;
}

fn intersection(a: f32, b: f32) -> f32 {
    return max(a, b);
}

fn difference(a: f32, b: f32) -> f32 {
    return max(a, -b);
}

// The distance from "column 1".
fn column_1(p: vec3<f32>) -> f32 {
    let box1 = box(p - triple(256), parameters[64].w, parameters[65].x, parameters[65].y, parameters[65].z);
    let cone1 = cone(p - triple(270), parameters[68].y, parameters[68].z, parameters[68].w, parameters[69].x, parameters[69].y, parameters[69].z);
    let torus1 = torus(p - triple(280), parameters[70].w, parameters[71].x);
    let smooth_union1 = smooth_union(cone1, torus1, parameters[66].x, parameters[66].y, parameters[66].z, parameters[66].w);
    let torus2 = torus(p - triple(287), parameters[72].z, parameters[72].w);
    let smooth_union2 = smooth_union(smooth_union1, torus2, parameters[66].x, parameters[66].y, parameters[66].z, parameters[66].w);
    let union1 = min(box1, smooth_union2);
    let box2 = box(p - triple(294), parameters[74].y, parameters[74].z, parameters[74].w, parameters[75].x);
    let union2 = min(union1, box2);
    let sphere1 = sphere(p - triple(304), parameters[76].w);
    let box3 = box(p - triple(309), parameters[78].x, parameters[78].y, parameters[78].z, parameters[78].w);
    let intersection1 = intersection(sphere1, box3);
    let sphere2 = sphere(p - triple(317), parameters[80].x);
    let difference1 = difference(intersection1, sphere2);
    return min(union2, difference1);
}

// The distance from "column 2".
fn column_2(p: vec3<f32>) -> f32 {
    let box1 = box(p - triple(322), parameters[81].y, parameters[81].z, parameters[81].w, parameters[82].x);
    let cone1 = cone(p - triple(336), parameters[84].w, parameters[85].x, parameters[85].y, parameters[85].z, parameters[85].w, parameters[86].x);
    let torus1 = torus(p - triple(346), parameters[87].y, parameters[87].z);
    let smooth_union1 = smooth_union(cone1, torus1, parameters[82].z, parameters[82].w, parameters[83].x, parameters[83].y);
    let torus2 = torus(p - triple(353), parameters[89].x, parameters[89].y);
    let smooth_union2 = smooth_union(smooth_union1, torus2, parameters[82].z, parameters[82].w, parameters[83].x, parameters[83].y);
    let union1 = min(box1, smooth_union2);
    let box2 = box(p - triple(360), parameters[90].w, parameters[91].x, parameters[91].y, parameters[91].z);
    let union2 = min(union1, box2);
    let sphere1 = sphere(p - triple(370), parameters[93].y);
    let box3 = box(p - triple(375), parameters[94].z, parameters[94].w, parameters[95].x, parameters[95].y);
    let intersection1 = intersection(sphere1, box3);
    let sphere2 = sphere(p - triple(383), parameters[96].z);
    let difference1 = difference(intersection1, sphere2);
    return min(union2, difference1);
}

// The distance from "column 3".
fn column_3(p: vec3<f32>) -> f32 {
    let box1 = box(p - triple(388), parameters[97].w, parameters[98].x, parameters[98].y, parameters[98].z);
    let cone1 = cone(p - triple(402), parameters[101].y, parameters[101].z, parameters[101].w, parameters[102].x, parameters[102].y, parameters[102].z);
    let torus1 = torus(p - triple(412), parameters[103].w, parameters[104].x);
    let smooth_union1 = smooth_union(cone1, torus1, parameters[99].x, parameters[99].y, parameters[99].z, parameters[99].w);
    let torus2 = torus(p - triple(419), parameters[105].z, parameters[105].w);
    let smooth_union2 = smooth_union(smooth_union1, torus2, parameters[99].x, parameters[99].y, parameters[99].z, parameters[99].w);
    let union1 = min(box1, smooth_union2);
    let box2 = box(p - triple(426), parameters[107].y, parameters[107].z, parameters[107].w, parameters[108].x);
    let union2 = min(union1, box2);
    let sphere1 = sphere(p - triple(436), parameters[109].w);
    let box3 = box(p - triple(441), parameters[111].x, parameters[111].y, parameters[111].z, parameters[111].w);
    let intersection1 = intersection(sphere1, box3);
    let sphere2 = sphere(p - triple(449), parameters[113].x);
    let difference1 = difference(intersection1, sphere2);
    return min(union2, difference1);
}

// How far a ray may go from a point before it meets a marched part, and which one: -2 for the box of the first, -3 for
// that of the second, and so on; -1 where that is no less than `most`.
fn nearest(p: vec3<f32>, most: f32) -> vec2<f32> {
    var d: vec2<f32> = vec2<f32>(most, -1.0);
    d = closer(d, column_1(p), 0.0);
    if apart(p, 76) < d.x {
        d = closer(d, column_2(p), 1.0);
    }
    if apart(p, 88) < d.x {
        d = closer(d, column_3(p), 2.0);
    }
    return d;
}

// How far a ray may go from a point before it meets one of all parts, and which one: see `nearest`.
fn reach_at(p: vec3<f32>, parts: i32) -> vec2<f32> {
    return nearest(p, FAR);
}

// How far a ray may go from a point in a direction.
fn free_ahead(p: vec3<f32>, direction: vec3<f32>) -> f32 {
    var free: f32 = FAR;
    return free;
}

// How far a ray may go from a point in a direction.
fn free_at(p: vec3<f32>, direction: vec3<f32>, parts: i32) -> f32 {
    return free_ahead(p, direction);
}

fn box_gradient(p: vec3<f32>, c0: f32, c1: f32, c2: f32, round_2: f32) -> vec4<f32> {
    let t1 = select(1.0, -1.0, p.x < 0.0);
    let t2 = select(1.0, -1.0, p.y < 0.0);
    let t3 = select(1.0, -1.0, p.z < 0.0);
    let t4 = abs(p.x) - c0;
    let t5 = abs(p.y) - c1;
    let t6 = abs(p.z) - c2;
    let t7 = max(t4, 0.0);
    let t8 = max(t5, 0.0);
    let t9 = max(t6, 0.0);
    let t10 = length(vec3<f32>(t7, t8, t9));
    let t11 = 0.0 < t10;
    let t12 = select(0.0, 1.0 / select(1.0, t10, t11), t11);
    let t13 = max(t4, t5);
    let t14 = t5 < t4;
    let t15 = max(t13, t6);
    let t16 = t6 < t13;
    let t17 = t15 < 0.0;
    return vec4<f32>(t7 * t12 * select(0.0, t1, 0.0 < t4) + select(0.0, select(0.0, select(0.0, t1, t14), t16), t17), t8 * t12 * select(0.0, t2, 0.0 < t5) + select(0.0, select(0.0, select(t2, 0.0, t14), t16), t17), t9 * t12 * select(0.0, t3, 0.0 < t6) + select(0.0, select(t3, 0.0, t16), t17), t10 + min(t15, 0.0) - round_2);
}

fn cone_gradient(p: vec3<f32>, bottom: f32, top: f32, half_height: f32, c3: f32, c4: f32, c5: f32) -> vec4<f32> {
    let t1 = length(p.xy);
    let t2 = 0.0 < t1;
    let t3 = select(0.0, 1.0 / select(1.0, t1, t2), t2);
    let t4 = p.x * t3;
    let t5 = p.y * t3;
    let t6 = t1 - bottom;
    let t7 = p.z + half_height;
    let t8 = t4 * c3;
    let t9 = t5 * c3;
    let t10 = t6 * c3 + t7 * c4;
    let t11 = (t7 * c3 - t6 * c4) * c5;
    let t12 = p.z < 0.0;
    let t13 = select(1.0, -1.0, t12);
    let t14 = abs(p.z) - half_height;
    let t15 = t1 - top;
    let t16 = p.z - half_height;
    let t17 = length(vec2<f32>(t15, t16));
    let t18 = 0.0 < t17;
    let t19 = select(0.0, 1.0 / select(1.0, t17, t18), t18);
    let t20 = t15 * t19;
    let t21 = length(vec2<f32>(t6, t7));
    let t22 = 0.0 < t21;
    let t23 = select(0.0, 1.0 / select(1.0, t21, t22), t22);
    let t24 = t6 * t23;
    let t25 = 0.0 < t11 && t11 < 1.0;
    let t26 = t10 < 0.0;
    let t27 = min(t21, t17);
    let t28 = t21 < t17;
    let t29 = select(t20 * t4, t24 * t4, t28);
    let t30 = select(t20 * t5, t24 * t5, t28);
    let t31 = select(t16 * t19, t7 * t23, t28);
    let t32 = select(t27, abs(t10), t25);
    let t33 = t1 < select(top, bottom, t12);
    let t34 = t14 < 0.0;
    let t35 = select(t27, abs(t14), t33);
    let t36 = t26 && t34;
    let t37 = t14 < t10;
    let t38 = t32 < t35;
    return vec4<f32>(select(select(select(t29, 0.0, t33), select(t29, select(t8, -t8, t26), t25), t38), select(0.0, t8, t37), t36), select(select(select(t30, 0.0, t33), select(t30, select(t9, -t9, t26), t25), t38), select(0.0, t9, t37), t36), select(select(select(t31, select(t13, -t13, t34), t33), select(t31, select(c4, -c4, t26), t25), t38), select(t13, c4, t37), t36), select(min(t32, t35), max(t10, t14), t36));
}

fn torus_gradient(p: vec3<f32>, major: f32, minor: f32) -> vec4<f32> {
    let t1 = length(p.xy);
    let t2 = 0.0 < t1;
    let t3 = select(0.0, 1.0 / select(1.0, t1, t2), t2);
    let t4 = t1 - major;
    let t5 = length(vec2<f32>(t4, p.z));
    let t6 = 0.0 < t5;
    let t7 = select(0.0, 1.0 / select(1.0, t5, t6), t6);
    let t8 = t4 * t7;
    return vec4<f32>(t8 * (p.x * t3), t8 * (p.y * t3), p.z * t7, t5 - minor);
}

fn smooth_union_gradient(a: vec4<f32>, b: vec4<f32>, k: f32, c1: f32, c2: f32, c3: f32) -> vec4<f32> {
    let t1 = a.w - b.w;
    let t2 = t1 < 0.0;
    let t3 = k - abs(t1);
    let t4 = 0.0 < t3;
    let t5 = max(t3, 0.0) * c1;
    let t6 = select(0.0, -select(1.0, -1.0, t2), t4) * c1;
    let t7 = select(0.0, -select(-1.0, 1.0, t2), t4) * c1;
    let t8 = a.w < b.w;
    let t9 = t5 * 2.0;
    let t10 = t5 * t5;
    let t11 = c2 + c3 * t5;
    return vec4<f32>((select(0.0, 1.0, t8) - (t6 * t9 * t11 + t10 * (c3 * t6))) * a.xyz + (select(1.0, 0.0, t8) - (t7 * t9 * t11 + t10 * (c3 * t7))) * b.xyz, min(a.w, b.w) - t10 * t11);
}

fn sphere_gradient(p: vec3<f32>, radius: f32) -> vec4<f32> {
    let t1 = length(p);
    let t2 = 0.0 < t1;
    let t3 = select(0.0, 1.0 / select(1.0, t1, t2), t2);
    return vec4<f32>(p.x * t3, p.y * t3, p.z * t3, t1 - radius);
}

fn intersection_gradient(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    let t1 = b.w < a.w;
    return vec4<f32>(select(0.0, 1.0, t1) * a.xyz + select(1.0, 0.0, t1) * b.xyz, max(a.w, b.w));
}

fn difference_gradient(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    let t1 = -b.w;
    let t2 = t1 < a.w;
    return vec4<f32>(select(0.0, 1.0, t2) * a.xyz + select(-1.0, 0.0, t2) * b.xyz, max(a.w, t1));
}

fn column_1_gradient(p: vec3<f32>, first: i32) -> vec4<f32> {
    let box1 = box_gradient(p - triple(first), parameter(first + 3), parameter(first + 4), parameter(first + 5), parameter(first + 6));
    let cone1 = cone_gradient(p - triple(first + 14), parameter(first + 17), parameter(first + 18), parameter(first + 19), parameter(first + 20), parameter(first + 21), parameter(first + 22));
    let torus1 = torus_gradient(p - triple(first + 24), parameter(first + 27), parameter(first + 28));
    let smooth_union1 = smooth_union_gradient(cone1, torus1, parameter(first + 8), parameter(first + 9), parameter(first + 10), parameter(first + 11));
    let torus2 = torus_gradient(p - triple(first + 31), parameter(first + 34), parameter(first + 35));
    let smooth_union2 = smooth_union_gradient(smooth_union1, torus2, parameter(first + 8), parameter(first + 9), parameter(first + 10), parameter(first + 11));
    let union1 = nearer(box1, smooth_union2);
    let box2 = box_gradient(p - triple(first + 38), parameter(first + 41), parameter(first + 42), parameter(first + 43), parameter(first + 44));
    let union2 = nearer(union1, box2);
    let sphere1 = sphere_gradient(p - triple(first + 48), parameter(first + 51));
    let box3 = box_gradient(p - triple(first + 53), parameter(first + 56), parameter(first + 57), parameter(first + 58), parameter(first + 59));
    let intersection1 = intersection_gradient(sphere1, box3);
    let sphere2 = sphere_gradient(p - triple(first + 61), parameter(first + 64));
    let difference1 = difference_gradient(intersection1, sphere2);
    return nearer(union2, difference1);
}

// The gradient of a part's field at a point, and its value.
fn part_gradient(part: i32, p: vec3<f32>) -> vec4<f32> {
    let form = i32(parameter(PARTS + PART_SIZE * part + 8));
    let first = i32(parameter(PARTS + PART_SIZE * part + 9));
    if form == 0 {
        return column_1_gradient(p, first);
    }
    return vec4<f32>(0.0);
}

// Marches along a ray through what `reach_at` knows as `parts`: all of them, or a single one.
fn march(ray: Ray, start: f32, end: f32, parts: i32) -> March {
    let scale = parameter(SCALE);
    var t: f32 = start;
    var steps: i32 = 0;
    var part: i32 = -1;
    var is_unresolved: bool = false;
    var gradient: vec4<f32> = vec4<f32>(0.0);
    // The field value that counts as a hit, in tolerances.
    var fineness: f32 = 1.0 / scale;
    for (var marches: i32 = 0; marches < MOST_MARCHES; marches++) {
        if t >= end {
            break;
        }
        var reach: f32 = 0.0;
        var near: vec2<f32> = vec2<f32>(FAR, -1.0);
        // How far the ray was free ahead of the point before, and how far the step from there went. Back from a point, only the ball
        // around it is free.
        var before: f32 = 0.0;
        var stride: f32 = 0.0;
        var is_near: bool = false;
        loop {
            let p = ray.origin + t * ray.direction;
            near = reach_at(p, parts);
            reach = tolerance_at(t, length(p)) * share_at(near.y);
            let ball = near.x * scale * parameter(STEP_FACTOR);
            if stride > before + max(ball, 0.0) && stride > 0.0 {
                t = t - stride + before;
                stride = before;
                steps = steps + 1;
                continue;
            }
            is_near = near.y >= 0.0 && near.x < max(reach * fineness, ROUNDING * length(p));
            if is_near || steps >= i32(parameter(MAX_STEPS)) {
                break;
            }
            before = ball;
            if is_formula(near.y) {
                before = max(ball, free_at(p, ray.direction, parts) * parameter(STEP_FACTOR));
            }
            stride = select(before, max(before, ball * RELAXATION), t + ball * RELAXATION < end);
            t = t + stride;
            steps = steps + 1;
            if t >= end {
                break;
            }
        }
        if t >= end && !is_near {
            break;
        }
        is_unresolved = !is_near;
        if near.y < 0.0 {
            break;
        }
        part = i32(near.y);
        gradient = part_gradient(part, ray.origin + t * ray.direction);
        let slope = max(length(gradient.xyz) * parameter(PARTS + PART_SIZE * part + 6), FLATTEST);
        if is_unresolved && near.x >= CREEPING * share_at(near.y) * reach * slope {
            part = -1;
            break;
        }
        // Rounding errors of values do not shrink with the slope.
        let least = ROUNDING * (length(ray.origin) + t);
        let is_false = near.x > FALSE_HIT * reach * slope && near.x > least;
        if !is_false || is_unresolved || marches + 1 == MOST_MARCHES {
            break;
        }
        fineness = slope;
        part = -1;
    }
    return March(t, part, steps, is_unresolved, gradient);
}

// The first part that a ray meets before it ends.
fn first_met(ray: Ray, end: f32) -> March {
    let span = clip(ray);
    return march(ray, span.x, min(span.y, end), 0);
}

// The first surface on a ray.
fn trace(ray: Ray) -> Hit {
    var plane_at: f32 = FAR;
    var plane: i32 = -1;
    for (var i: i32 = 0; i < PLANE_COUNT; i++) {
        let t_plane = plane_hit(ray, PLANES + PLANE_SIZE * i);
        if t_plane < plane_at {
            plane_at = t_plane;
            plane = i;
        }
    }
    let met = first_met(ray, min(plane_at, parameter(MAX_DISTANCE)));
    let viewer = -ray.direction;
    if met.part >= 0 {
        let position = ray.origin + met.distance * ray.direction;
        let steepness = length(met.gradient.xyz);
        let normal = select(viewer, met.gradient.xyz / max(steepness, 1e-30), steepness > 0.0);
        let away = tolerance_at(met.distance, length(position));
        let slope = clamp(steepness * parameter(PARTS + PART_SIZE * met.part + 6), FLATTEST, 1.0);
        let facing_normal = facing(normal, viewer, met.part);
        return Hit(met.distance, met.part, met.steps, met.is_unresolved, position, facing_normal, viewer, away, away, slope);
    }
    if plane >= 0 {
        let position = ray.origin + plane_at * ray.direction;
        let number = PART_COUNT + plane;
        let normal = facing(triple(PLANES + PLANE_SIZE * plane), viewer, number);
        let offset = length(position);
        let away = ROUNDING * max(offset, plane_at);
        let tolerance = tolerance_at(plane_at, offset);
        let slope = 1.0 / parameter(SCALE);
        return Hit(plane_at, number, met.steps, met.is_unresolved, position, normal, viewer, away, tolerance, slope);
    }
    return Hit(FAR, -1, met.steps, met.is_unresolved, ray.origin, vec3<f32>(0.0), viewer, 0.0, 0.0, 1.0);
}

// The light whose numbers begin at `first` as it arrives at a point if nothing stands in between.
fn incoming(first: i32, p: vec3<f32>) -> Incoming {
    let power_of = triple(first + 4);
    if parameter(first) == 0.0 {
        return Incoming(triple(first + 1), FAR, power_of);
    }
    let way = triple(first + 1) - p;
    let distance = max(length(way), NEAREST_LIGHT);
    let direction = way / distance;
    let weakening = parameter(first + 7) + distance * (parameter(first + 8) + distance * parameter(first + 9));
    var share: f32 = 1.0;
    if parameter(first + 10) > 0.0 {
        let cosine = -dot(direction, triple(first + 11));
        if cosine < parameter(first + 15) {
            let outer = parameter(first + 14);
            let t = clamp((cosine - outer) / (parameter(first + 15) - outer), 0.0, 1.0);
            share = t * t * (3.0 - 2.0 * t);
        }
    }
    return Incoming(direction, distance, power_of * (share / max(weakening, 1e-12)));
}

// The light that leaves towards the viewer.
fn reflected(surface: Surface, hit: Hit, incoming_light: Incoming, n_dot_l: f32) -> vec3<f32> {
    var highlight: f32 = 0.0;
    if surface.shares.z > 0.0 {
        var cosine: f32 = 0.0;
        if surface.is_blinn {
            let between = incoming_light.direction + hit.viewer;
            cosine = dot(hit.normal, between) / max(length(between), 1e-30);
        } else {
            cosine = dot(2.0 * n_dot_l * hit.normal - incoming_light.direction, hit.viewer);
        }
        if cosine > 0.0 {
            highlight = surface.shares.z * pow(min(cosine, 1.0), surface.exponent);
        }
    }
    return incoming_light.light * (surface.shares.y * n_dot_l * surface.color + vec3<f32>(highlight));
}

// The part of a ray where a ball is nearer than the distance travelled over `sharpness`.
fn penumbra(ray: Ray, middle: vec3<f32>, radius: f32, sharpness: f32) -> vec2<f32> {
    let away = ray.origin - middle;
    let spread = 1.0 / sharpness;
    let a = 1.0 - spread * spread;
    if radius > 1e12 || a <= 0.0 {
        return vec2<f32>(0.0, FAR);
    }
    let b = dot(away, ray.direction) - radius * spread;
    let c = dot(away, away) - radius * radius;
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return vec2<f32>(0.0, -1.0);
    }
    let root = sqrt(discriminant);
    return vec2<f32>(max((-b - root) / a, 0.0), (-b + root) / a);
}

// How far the nearest surface seems to be. Warped distances are divided by their slope there, since safe steps are much shorter;
// formulas have no scale, so that they dim all or nothing.
fn seen_clearance(near: vec2<f32>, p: vec3<f32>) -> f32 {
    let safe = near.x * parameter(SCALE);
    if FORMULA_COUNT == 0 || near.y == -1.0 {
        return safe;
    }
    let part = select(i32(near.y), -2 - i32(near.y), near.y < 0.0);
    let metric = parameter(PARTS + PART_SIZE * part + 10);
    if metric == 0.0 {
        return safe;
    }
    if metric == 2.0 {
        return FAR;
    }
    let value = part_gradient(part, p);
    return max(safe, value.w / max(length(value.xyz), 1e-30));
}

// The field of all that is marched at a point, and the part that it belongs to; -1 where that is no less than `most`.
fn unscaled(p: vec3<f32>, most: f32) -> vec2<f32> {
    return nearest(p, most);
}

// How far away the nearest surface seems to be from a point that need not be outside of all. What has no scale, or a warped one,
// is divided by its slope there, which is right to first order; without a slope nothing is known to be near. No more than `most`.
fn clearance(p: vec3<f32>, most: f32) -> f32 {
    // Values of formulas are no distances to be compared with.
    let near = unscaled(p, select(most, FAR, FORMULA_COUNT > 0));
    var free: f32 = near.x;
    if FORMULA_COUNT > 0 && near.y >= 0.0 {
        if parameter(PARTS + PART_SIZE * i32(near.y) + 10) > 0.0 {
            let value = part_gradient(i32(near.y), p);
            let steepness = length(value.xyz);
            free = select(FAR, max(value.w, 0.0) / max(steepness, 1e-30), steepness > 0.0);
        }
    }
    return nearest_plane(vec2<f32>(free, -1.0), p).x;
}

// What is left of a light along a ray through what `reach_at` knows as `parts`.
fn light_along(ray: Ray, start: f32, end: f32, shade_of: Shade, parts: i32) -> f32 {
    var t: f32 = start;
    var factor: f32 = 1.0;
    var before: f32 = FAR;
    for (var steps: i32 = 0; steps < i32(parameter(MAX_STEPS)); steps++) {
        if t >= end {
            break;
        }
        let p = ray.origin + t * ray.direction;
        let near = reach_at(p, parts);
        let value = near.x;
        if near.y >= 0.0 && value < shade_of.base * share_at(near.y) + shade_of.growth * t {
            return 0.0;
        }
        var clearance: f32 = value * parameter(SCALE);
        if !shade_of.is_soft && is_formula(near.y) {
            clearance = max(clearance, free_at(p, ray.direction, parts));
        }
        var step_length: f32 = clearance;
        if shade_of.is_soft {
            let here = shade_of.sharpness * seen_clearance(near, p) / max(t, 1e-30);
            factor = min(factor, here);
            if factor < NEGLIGIBLE {
                return 0.0;
            }
            // Up to where clearance over distance could first fall below the least ratio so far.
            let ratio = factor / shade_of.sharpness;
            let safe = (clearance - t * ratio) / (1.0 + ratio);
            let short_step = select(clearance * SHORTEST_STEP, clearance, here >= before * STEADY);
            step_length = max(safe, short_step);
            before = here;
        }
        t = t + step_length * parameter(STEP_FACTOR);
    }
    // A ray that still creeps along a formula grazes it.
    if FORMULA_COUNT > 0 && t < end {
        return 0.0;
    }
    return factor;
}

// What the parts leave of a light along a ray.
fn light_past(ray: Ray, end: f32, shade_of: Shade) -> f32 {
    var span: vec2<f32> = clip(ray);
    if shade_of.is_soft {
        let half = 0.5 * (triple(BOUNDS + 3) - triple(BOUNDS));
        span = penumbra(ray, triple(BOUNDS) + half, length(half), shade_of.sharpness * parameter(SCALE));
    }
    return light_along(ray, span.x, min(span.y, end), shade_of, 0);
}

// The part of a light that arrives at a hit.
fn shadow(first: i32, hit: Hit, incoming_light: Incoming) -> f32 {
    let kind = parameter(first + 16);
    if kind == NO_SHADOW {
        return 1.0;
    }
    let ray = Ray(hit.position + SHADOW_START * hit.uncertainty * hit.normal, incoming_light.direction);
    for (var i: i32 = 0; i < PLANE_COUNT; i++) {
        if plane_hit(ray, PLANES + PLANE_SIZE * i) < min(incoming_light.distance, 0.5 * FAR) {
            return 0.0;
        }
    }
    if PART_COUNT == 0 {
        return 1.0;
    }
    var sharpness: f32 = parameter(first + 17);
    if kind > SHARPNESS {
        sharpness = incoming_light.distance / sharpness;
    }
    let base = (SHADOW_HIT * hit.tolerance + ROUNDING * length(ray.origin)) * hit.slope;
    let shade_of = Shade(kind >= SHARPNESS, sharpness, base, ROUNDING * hit.slope);
    return light_past(ray, min(parameter(MAX_DISTANCE), incoming_light.distance), shade_of);
}

// The share of the ambient light that the surroundings of a hit leave.
fn openness(hit: Hit) -> f32 {
    var occluded: f32 = 0.0;
    for (var i: i32 = 0; i < 5; i++) {
        let weight = parameter(OCCLUSION + 5 + i);
        if weight > 0.0 {
            let height = parameter(OCCLUSION + i);
            occluded = occluded + weight * max(height - clearance(hit.position + height * hit.normal, height), 0.0);
        }
    }
    return clamp(1.0 - occluded, 0.0, 1.0);
}

// What a ray sees that meets nothing.
fn seen_behind(ray: Ray) -> vec3<f32> {
    return mix(triple(BACKGROUND), triple(BACKGROUND + 3), 0.5 + 0.5 * ray.direction.z);
}

// The part of the surface that a ray stands for where it hits.
fn spot_of(hit: Hit) -> Spot {
    return Spot(hit.position, hit.normal, hit.viewer, width_at(hit.distance), hit.uncertainty);
}

fn union_share(a: f32, b: f32) -> f32 {
    return select(0.0, 1.0, b < a);
}

fn difference_share(a: f32, b: f32, c0: f32) -> f32 {
    return select(0.0, -c0 + 1.0, a < -b);
}

fn intersection_share(a: f32, b: f32, c0: f32) -> f32 {
    return select(0.0, -c0 + 1.0, a < b);
}

fn smooth_union_share(a: f32, b: f32, k: f32, c1: f32, c4: f32, c5: f32) -> f32 {
    let t1 = max(k - abs(a - b), 0.0) * c1;
    let t2 = t1 * (c4 + c5 * t1);
    return select(t2, -t2 + 1.0, b < a);
}

fn column_1_surface(spot: Spot) -> Surface {
    let p = spot.position;
    let box1 = box(p - triple(256), parameters[64].w, parameters[65].x, parameters[65].y, parameters[65].z);
    let cone1 = cone(p - triple(270), parameters[68].y, parameters[68].z, parameters[68].w, parameters[69].x, parameters[69].y, parameters[69].z);
    let torus1 = torus(p - triple(280), parameters[70].w, parameters[71].x);
    let smooth_union1 = smooth_union(cone1, torus1, parameters[66].x, parameters[66].y, parameters[66].z, parameters[66].w);
    let torus2 = torus(p - triple(287), parameters[72].z, parameters[72].w);
    let smooth_union2 = smooth_union(smooth_union1, torus2, parameters[66].x, parameters[66].y, parameters[66].z, parameters[66].w);
    let union1 = min(box1, smooth_union2);
    let box2 = box(p - triple(294), parameters[74].y, parameters[74].z, parameters[74].w, parameters[75].x);
    let union2 = min(union1, box2);
    let sphere1 = sphere(p - triple(304), parameters[76].w);
    let box3 = box(p - triple(309), parameters[78].x, parameters[78].y, parameters[78].z, parameters[78].w);
    let intersection1 = intersection(sphere1, box3);
    let sphere2 = sphere(p - triple(317), parameters[80].x);
    let difference1 = difference(intersection1, sphere2);
    let union3 = min(union2, difference1);
    let share1 = union_share(union2, difference1);
    let rest1 = 1.0 - share1;
    let share2 = share1 * difference_share(intersection1, sphere2, parameters[75].z);
    let rest2 = share1 - share2;
    let share3 = rest2 * intersection_share(sphere1, box3, parameters[75].w);
    let rest3 = rest2 - share3;
    let share4 = rest1 * union_share(union1, box2);
    let rest4 = rest1 - share4;
    let share5 = rest4 * union_share(box1, smooth_union2);
    let rest5 = rest4 - share5;
    let share6 = share5 * smooth_union_share(smooth_union1, torus2, parameters[66].x, parameters[66].y, parameters[67].x, parameters[67].y);
    let rest6 = share5 - share6;
    let share7 = rest6 * smooth_union_share(cone1, torus1, parameters[66].x, parameters[66].y, parameters[67].x, parameters[67].y);
    let rest7 = rest6 - share7;
    var surface: Surface = no_surface();
    surface = with_share(surface, share4 + share6 + share7 + rest7 + rest5, 106, spot);
    surface = with_share(surface, share2 + share3 + rest3, 190, spot);
    return settled(surface);
}

fn column_2_surface(spot: Spot) -> Surface {
    let p = spot.position;
    let box1 = box(p - triple(322), parameters[81].y, parameters[81].z, parameters[81].w, parameters[82].x);
    let cone1 = cone(p - triple(336), parameters[84].w, parameters[85].x, parameters[85].y, parameters[85].z, parameters[85].w, parameters[86].x);
    let torus1 = torus(p - triple(346), parameters[87].y, parameters[87].z);
    let smooth_union1 = smooth_union(cone1, torus1, parameters[82].z, parameters[82].w, parameters[83].x, parameters[83].y);
    let torus2 = torus(p - triple(353), parameters[89].x, parameters[89].y);
    let smooth_union2 = smooth_union(smooth_union1, torus2, parameters[82].z, parameters[82].w, parameters[83].x, parameters[83].y);
    let union1 = min(box1, smooth_union2);
    let box2 = box(p - triple(360), parameters[90].w, parameters[91].x, parameters[91].y, parameters[91].z);
    let union2 = min(union1, box2);
    let sphere1 = sphere(p - triple(370), parameters[93].y);
    let box3 = box(p - triple(375), parameters[94].z, parameters[94].w, parameters[95].x, parameters[95].y);
    let intersection1 = intersection(sphere1, box3);
    let sphere2 = sphere(p - triple(383), parameters[96].z);
    let difference1 = difference(intersection1, sphere2);
    let union3 = min(union2, difference1);
    let share1 = union_share(union2, difference1);
    let rest1 = 1.0 - share1;
    let share2 = share1 * difference_share(intersection1, sphere2, parameters[92].x);
    let rest2 = share1 - share2;
    let share3 = rest2 * intersection_share(sphere1, box3, parameters[92].y);
    let rest3 = rest2 - share3;
    let share4 = rest1 * union_share(union1, box2);
    let rest4 = rest1 - share4;
    let share5 = rest4 * union_share(box1, smooth_union2);
    let rest5 = rest4 - share5;
    let share6 = share5 * smooth_union_share(smooth_union1, torus2, parameters[82].z, parameters[82].w, parameters[83].z, parameters[83].w);
    let rest6 = share5 - share6;
    let share7 = rest6 * smooth_union_share(cone1, torus1, parameters[82].z, parameters[82].w, parameters[83].z, parameters[83].w);
    let rest7 = rest6 - share7;
    var surface: Surface = no_surface();
    surface = with_share(surface, share4 + share6 + share7 + rest7 + rest5, 127, spot);
    surface = with_share(surface, share2 + share3 + rest3, 211, spot);
    return settled(surface);
}

fn column_3_surface(spot: Spot) -> Surface {
    let p = spot.position;
    let box1 = box(p - triple(388), parameters[97].w, parameters[98].x, parameters[98].y, parameters[98].z);
    let cone1 = cone(p - triple(402), parameters[101].y, parameters[101].z, parameters[101].w, parameters[102].x, parameters[102].y, parameters[102].z);
    let torus1 = torus(p - triple(412), parameters[103].w, parameters[104].x);
    let smooth_union1 = smooth_union(cone1, torus1, parameters[99].x, parameters[99].y, parameters[99].z, parameters[99].w);
    let torus2 = torus(p - triple(419), parameters[105].z, parameters[105].w);
    let smooth_union2 = smooth_union(smooth_union1, torus2, parameters[99].x, parameters[99].y, parameters[99].z, parameters[99].w);
    let union1 = min(box1, smooth_union2);
    let box2 = box(p - triple(426), parameters[107].y, parameters[107].z, parameters[107].w, parameters[108].x);
    let union2 = min(union1, box2);
    let sphere1 = sphere(p - triple(436), parameters[109].w);
    let box3 = box(p - triple(441), parameters[111].x, parameters[111].y, parameters[111].z, parameters[111].w);
    let intersection1 = intersection(sphere1, box3);
    let sphere2 = sphere(p - triple(449), parameters[113].x);
    let difference1 = difference(intersection1, sphere2);
    let union3 = min(union2, difference1);
    let share1 = union_share(union2, difference1);
    let rest1 = 1.0 - share1;
    let share2 = share1 * difference_share(intersection1, sphere2, parameters[108].z);
    let rest2 = share1 - share2;
    let share3 = rest2 * intersection_share(sphere1, box3, parameters[108].w);
    let rest3 = rest2 - share3;
    let share4 = rest1 * union_share(union1, box2);
    let rest4 = rest1 - share4;
    let share5 = rest4 * union_share(box1, smooth_union2);
    let rest5 = rest4 - share5;
    let share6 = share5 * smooth_union_share(smooth_union1, torus2, parameters[99].x, parameters[99].y, parameters[100].x, parameters[100].y);
    let rest6 = share5 - share6;
    let share7 = rest6 * smooth_union_share(cone1, torus1, parameters[99].x, parameters[99].y, parameters[100].x, parameters[100].y);
    let rest7 = rest6 - share7;
    var surface: Surface = no_surface();
    surface = with_share(surface, share4 + share6 + share7 + rest7 + rest5, 148, spot);
    surface = with_share(surface, share2 + share3 + rest3, 232, spot);
    return settled(surface);
}

// What a part or a plane looks like at a point of its surface.
fn surface_at(part: i32, spot: Spot) -> Surface {
    if part == 0 {
        return column_1_surface(spot);
    }
    if part == 1 {
        return column_2_surface(spot);
    }
    if part == 2 {
        return column_3_surface(spot);
    }
    return with_share(no_surface(), 1.0, REGIONS + REGION_SIZE * part, spot);
}

// The linear colour that a ray sees which met something.
fn shade(hit: Hit) -> vec3<f32> {
    let surface = surface_at(hit.part, spot_of(hit));
    let around = mix(triple(AMBIENT), triple(AMBIENT + 3), 0.5 + 0.5 * hit.normal.z);
    var color: vec3<f32> = surface.emissive;
    if surface.shares.x > 0.0 {
        color = color + surface.shares.x * openness(hit) * surface.color * around;
    }
    if surface.shares.y > 0.0 || surface.shares.z > 0.0 {
        for (var i: i32 = 0; i < i32(parameter(LIGHT_COUNT)); i++) {
            let first = LIGHTS + LIGHT_SIZE * i;
            let light = incoming(first, hit.position);
            let n_dot_l = dot(hit.normal, light.direction);
            if n_dot_l > 0.0 && light.light.x + light.light.y + light.light.z > 0.0 {
                color = color + shadow(first, hit, light) * reflected(surface, hit, light, n_dot_l);
            }
        }
    }
    return color;
}

// The distance of a hit from the eye's plane.
fn depth_of(hit: Hit) -> f32 {
    return hit.distance * dot(-hit.viewer, triple(FORWARD));
}

// From black over blue, red and yellow to white.
fn heat(x: f32) -> vec3<f32> {
    let t = 4.0 * clamp(x, 0.0, 1.0);
    return vec3<f32>(clamp(t - 1.0, 0.0, 1.0), clamp(t - 2.0, 0.0, 1.0), clamp(t, 0.0, 1.0) - clamp(t - 1.0, 0.0, 1.0) + clamp(t - 3.0, 0.0, 1.0));
}

// The linear colour that a ray sees, or one of the numbers behind it.
fn sample_along(ray: Ray) -> vec4<f32> {
    let hit = trace(ray);
    let has_met = hit.part >= 0;
    if view.show == SHOW_LIT {
        let given_up = select(0.0, 1.0, hit.is_unresolved);
        if hit.is_unresolved && parameter(WARNING) > 0.0 {
            return vec4<f32>(triple(WARNING + 1), given_up);
        }
        if has_met {
            return vec4<f32>(shade(hit), given_up);
        }
        return vec4<f32>(seen_behind(ray), given_up);
    }
    if view.show == LAYER_NORMAL {
        return vec4<f32>(hit.normal, select(-1.0, hit.distance, has_met));
    }
    var object: f32 = -1.0;
    if has_met {
        object = surface_at(hit.part, spot_of(hit)).object;
    }
    if view.show == LAYER_NUMBERS {
        let depth = select(-1.0, depth_of(hit), has_met);
        return vec4<f32>(depth, object, f32(hit.steps), select(0.0, 1.0, hit.is_unresolved));
    }
    if view.show == SHOW_STEPS {
        return vec4<f32>(heat(f32(hit.steps) / 64.0), 1.0);
    }
    if !has_met {
        return vec4<f32>(0.0);
    }
    if view.show == SHOW_NORMALS {
        return vec4<f32>(0.5 + 0.5 * hit.normal.x, 0.5 + 0.5 * hit.normal.y, 0.5 + 0.5 * hit.normal.z, 1.0);
    }
    if view.show == SHOW_OBJECTS {
        let hue = fract(0.381966 * object);
        return vec4<f32>(heat(hue), 1.0);
    }
    let near = parameter(SCENE_SIZE) / (parameter(SCENE_SIZE) + depth_of(hit));
    return vec4<f32>(near, near, near, 1.0);
}

fn srgb(channel: f32) -> f32 {
    let x = clamp(channel, 0.0, 1.0);
    return select(1.055 * pow(x, 0.41666666) - 0.055, 12.92 * x, x <= 0.0031308);
}

// From scene light to the range of a display, in sRGB.
fn encoded(light: vec3<f32>) -> vec3<f32> {
    var color: vec3<f32> = light * parameter(GAIN);
    let brightest = max(max(color.x, color.y), color.z);
    if parameter(SCALES_DOWN) > 0.0 && brightest > 1.0 {
        color = color / brightest;
    }
    return vec3<f32>(srgb(color.x), srgb(color.y), srgb(color.z));
}

// What a display shows where a ray leads to.
fn shown_along(ray: Ray) -> vec3<f32> {
    let value = sample_along(ray);
    if view.show == SHOW_LIT {
        return encoded(value.xyz);
    }
    return value.xyz;
}

// The field of the whole scene at a point, and the part that it belongs to.
fn whole(p: vec3<f32>) -> vec2<f32> {
    return nearest_plane(unscaled(p, FAR), p);
}

// The gradient of the whole scene's field at a point, and its value.
fn field_gradient(p: vec3<f32>) -> vec4<f32> {
    let d = whole(p);
    let part = i32(d.y);
    if part < PART_COUNT {
        return part_gradient(part, p);
    }
    let first = PLANES + PLANE_SIZE * (part - PART_COUNT);
    let is_turned = parameter(first + 4) > 0.0 && dot(triple(first), p) < parameter(first + 3);
    return vec4<f32>(select(1.0, -1.0, is_turned) * parameter(first + 5) * triple(first), d.x);
}

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
