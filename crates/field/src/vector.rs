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
