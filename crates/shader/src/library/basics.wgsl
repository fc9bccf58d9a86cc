// Farther than anything.
const FAR: f32 = 1e30;

// Rounding errors of a field value, relative to the coordinates.
const ROUNDING: f32 = 4.7683716e-7;

// Three parameters as a vector.
fn triple(first: i32) -> vec3<f32> {
    return vec3<f32>(parameters[first], parameters[first + 1], parameters[first + 2]);
}

// Nine parameters as a matrix, by columns.
fn matrix(first: i32) -> mat3x3<f32> {
    return mat3x3<f32>(triple(first), triple(first + 3), triple(first + 6));
}

// The power of a number that may be negative, if the exponent is whole.
fn power(base: f32, exponent: f32) -> f32 {
    if (exponent == 0.0) {
        return 1.0;
    }
    let positive: f32 = pow(abs(base), exponent);
    if (base < 0.0 && fract(0.5 * exponent) != 0.0) {
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

// A value after its gradient, as it is before a map with these derivatives.
fn turned(value: vec4<f32>, map: mat3x3<f32>) -> vec4<f32> {
    return vec4<f32>(value.xyz * map, value.w);
}

// The distance from a box, given by its middle and half its edges; 0 inside.
fn apart(p: vec3<f32>, first: i32) -> f32 {
    return length(max(abs(p - triple(first)) - triple(first + 3), vec3<f32>(0.0)));
}
