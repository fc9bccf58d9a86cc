//! Points and directions over any [`Scalar`].

use crate::scalar::Scalar;
use std::ops::{Add, Mul, Sub};

/// Three coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the coordinates speak for themselves")]
pub struct Vec3<S> {
    pub x: S,
    pub y: S,
    pub z: S,
}

/// Makes a [`Vec3`].
#[inline(always)]
pub fn vec3<S>(x: S, y: S, z: S) -> Vec3<S> {
    Vec3 { x, y, z }
}

impl<S: Scalar> Vec3<S> {
    /// The scalar product.
    #[inline(always)]
    pub fn dot(self, rhs: Self) -> S {
        self.x * rhs.x + self.y * rhs.y + self.z * rhs.z
    }

    /// The Euclidean length.
    #[inline(always)]
    pub fn length(self) -> S {
        S::length3(self.x, self.y, self.z)
    }

    /// Absolute values of the coordinates.
    #[inline(always)]
    pub fn abs(self) -> Self {
        vec3(self.x.abs(), self.y.abs(), self.z.abs())
    }
}

impl<S: Scalar> From<[S; 3]> for Vec3<S> {
    #[inline(always)]
    fn from([x, y, z]: [S; 3]) -> Self {
        vec3(x, y, z)
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: Self) -> Self {
        vec3(self.x + rhs.x, self.y + rhs.y, self.z + rhs.z)
    }
}

impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: Self) -> Self {
        vec3(self.x - rhs.x, self.y - rhs.y, self.z - rhs.z)
    }
}

impl<S: Scalar> Mul<S> for Vec3<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: S) -> Self {
        vec3(self.x * rhs, self.y * rhs, self.z * rhs)
    }
}

/// An upper bound, good to a few units in the last place, of the largest factor by which a matrix stretches a vector.
///
/// That is the root of the largest eigenvalue of `M^T M`, which has a closed form (Smith, "Eigenvalues of a Symmetric 3 x 3
/// Matrix", 1961).
pub fn spectral_norm(matrix: glam::DMat3) -> f64 {
    /// The closed form's rounding errors, relative to the largest entry: the angle is found to half the digits where two
    /// eigenvalues are near each other, and then enters by its cosine, that is squared.
    const ROUNDING: f64 = 64.0 * f64::EPSILON;
    let gram = matrix.transpose() * matrix;
    let [[a, d, e], [_, b, f], [_, _, c]] = gram.to_cols_array_2d();
    let middle = (a + b + c) / 3.0;
    let spread = (((a - middle).powi(2) + (b - middle).powi(2) + (c - middle).powi(2) + 2.0 * (d * d + e * e + f * f))
        / 6.0)
        .sqrt();
    let largest = if spread > 0.0 {
        let half_determinant =
            ((gram - glam::DMat3::from_diagonal(glam::DVec3::splat(middle))) * (1.0 / spread)).determinant() / 2.0;
        let angle = libm::acos(half_determinant.clamp(-1.0, 1.0)) / 3.0;
        middle + 2.0 * spread * libm::cos(angle)
    } else {
        middle
    };
    (largest * (1.0 + ROUNDING)).sqrt()
}
