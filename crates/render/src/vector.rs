//! Three-component arithmetic in single precision, for positions, directions and linear colours.

/// Three numbers.
pub(crate) type Triple = [f32; 3];

/// The scalar product.
#[inline]
pub(crate) fn dot(a: Triple, b: Triple) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The sum of `a` and `s` times `b`.
#[inline]
pub(crate) fn add_scaled(a: Triple, s: f32, b: Triple) -> Triple {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// The product, component by component.
#[inline]
pub(crate) fn times(a: Triple, b: Triple) -> Triple {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// Each component times `s`.
#[inline]
pub(crate) fn scaled(a: Triple, s: f32) -> Triple {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// The Euclidean length.
#[inline]
pub(crate) fn length(a: Triple) -> f32 {
    dot(a, a).sqrt()
}

/// `a` where `share` is 0, `b` where it is 1.
#[inline]
pub(crate) fn mix(a: Triple, b: Triple, share: f32) -> Triple {
    add_scaled(scaled(a, 1.0 - share), share, b)
}
