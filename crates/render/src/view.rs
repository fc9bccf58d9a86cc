//! From pixels to rays: the camera's frame, its projections, and a camera for scenes that have none.
//!
//! The frame is right-handed: `right`, `up`, and `-forward`. Raster coordinates start at the upper left
//! corner of the picture, so that the centre of the first pixel is (0.5, 0.5).

use freikugel_field::Aabb;
use freikugel_scene::{Camera, FovAxis, Projection};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::fmt;

/// Where the camera of a scene without one stands, seen from its target: in front, to the right, above.
const DEFAULT_DIRECTION: DVec3 = DVec3::new(1.0, -1.6, 0.9);

/// How far that camera is from its target if nothing in the scene has a size.
const DEFAULT_DISTANCE: f64 = 8.0;

/// The part of the picture that a scene framed automatically spans at most.
const FRAMED_SHARE: f64 = 0.86;

/// Below this sine of the angle between them, `up` is taken to be parallel to the view.
const PARALLEL: f64 = 1e-9;

/// Why a camera shows nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraError {
    /// A coordinate is infinite or not a number.
    NotFinite,
    /// Eye and target coincide, so there is no direction to look in.
    NoDirection,
    /// The field of view is not between 0 and 180 degrees.
    FieldOfView,
    /// The height of an orthographic view is not above 0.
    Height,
}

/// A camera and a picture's size, made ready for casting rays.
#[derive(Clone, Debug)]
pub(crate) struct View {
    pub(crate) eye: DVec3,
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    pub(crate) forward: DVec3,
    /// Half the picture's extent: on the plane at distance 1 for a perspective, in the world otherwise.
    pub(crate) half: DVec2,
    pub(crate) is_perspective: bool,
    size: DVec2,
}

/// A half-line with a unit direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
}

impl View {
    pub(crate) fn new(camera: &Camera, width: u32, height: u32) -> Result<Self, CameraError> {
        let Camera { eye, target, up, projection } = *camera;
        let view = target - eye;
        if !(eye.is_finite() && view.is_finite() && up.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        let forward = view.try_normalize().ok_or(CameraError::NoDirection)?;
        let right = forward.cross(sideways_up(forward, up)).normalize();
        let size = DVec2::new(width.into(), height.into());
        let aspect = size.x / size.y;
        let (half, is_perspective) = match projection {
            Projection::Perspective { fov, axis } => {
                if !(fov > 0.0 && fov < PI) {
                    return Err(CameraError::FieldOfView);
                }
                let tangent = libm::tan(fov / 2.0);
                let half = match axis {
                    FovAxis::Vertical => DVec2::new(tangent * aspect, tangent),
                    FovAxis::Horizontal => DVec2::new(tangent, tangent / aspect),
                };
                (half, true)
            }
            Projection::Orthographic { height } => {
                if !(height > 0.0 && height.is_finite()) {
                    return Err(CameraError::Height);
                }
                (DVec2::new(height * aspect, height) / 2.0, false)
            }
        };
        Ok(Self { eye, right, up: right.cross(forward), forward, half, is_perspective, size })
    }

    /// The ray through a point of the picture in raster coordinates.
    #[inline(always)]
    pub(crate) fn ray(&self, raster: DVec2) -> Ray {
        let x = (2.0 * raster.x / self.size.x - 1.0) * self.half.x;
        let y = (1.0 - 2.0 * raster.y / self.size.y) * self.half.y;
        let offset = self.right * x + self.up * y;
        if self.is_perspective {
            Ray { origin: self.eye, direction: (self.forward + offset).normalize() }
        } else {
            Ray { origin: self.eye + offset, direction: self.forward }
        }
    }

    /// Distance from the eye's plane of a point at distance `t` along a ray of this camera.
    pub(crate) fn depth(&self, ray: &Ray, t: f64) -> f64 {
        t * ray.direction.dot(self.forward)
    }

    /// The width of a pixel in the world: what it is everywhere, and what it gains per unit of distance.
    pub(crate) fn footprint(&self) -> (f64, f64) {
        let pixel = 2.0 * self.half.y / self.size.y;
        if self.is_perspective { (0.0, pixel) } else { (pixel, 0.0) }
    }
}

/// `up`, or where that is parallel to the view, the axis that serves best instead: y, so that looking
/// straight down shows a map with x to the right.
fn sideways_up(forward: DVec3, up: DVec3) -> DVec3 {
    [up, DVec3::Y, DVec3::Z]
        .into_iter()
        .filter_map(DVec3::try_normalize)
        .find(|up| forward.cross(*up).length() > PARALLEL)
        .expect("y and z are not both parallel to the view")
}

/// A three-quarter view that just holds `extent`, or the surroundings of the origin if there is none.
pub(crate) fn framed(extent: Option<Aabb>, width: u32, height: u32) -> Camera {
    let back = DEFAULT_DIRECTION.normalize();
    let Some(extent) = extent.filter(|extent| extent.size().max_element() > 0.0) else {
        let target = extent.map_or(DVec3::ZERO, Aabb::center);
        return Camera { eye: target + back * DEFAULT_DISTANCE, target, ..Camera::default() };
    };
    let target = extent.center();
    let camera = Camera { eye: target + back, target, ..Camera::default() };
    let Ok(view) = View::new(&camera, width, height) else {
        return camera;
    };
    let half = view.half * FRAMED_SHARE;
    let corner = extent.size() / 2.0;
    let distance = (0..8)
        .map(|index| {
            let sign = |bit: u32| if index & (1 << bit) == 0 { -1.0 } else { 1.0 };
            let corner = corner * DVec3::new(sign(0), sign(1), sign(2));
            let aside = DVec2::new(corner.dot(view.right), corner.dot(view.up)).abs() / half;
            // The corner is inside the picture if its depth, the distance less this, is at least `aside`.
            corner.dot(back) + aside.max_element()
        })
        .fold(0.0, f64::max);
    Camera { eye: target + back * distance, ..camera }
}

/// The part of a ray inside a box, as distances from its origin.
pub(crate) fn clip(bounds: &Aabb, ray: &Ray) -> Option<(f64, f64)> {
    let (near, far) = walls(bounds, ray);
    (near <= far).then_some((near, far))
}

/// Where a ray enters a box, from its origin on, and where it leaves it; in the wrong order if it misses the box.
#[inline(always)]
pub(crate) fn walls(bounds: &Aabb, ray: &Ray) -> (f64, f64) {
    let (mut near, mut far) = (0.0, f64::INFINITY);
    for axis in 0..3 {
        let (origin, inverse) = (ray.origin[axis], 1.0 / ray.direction[axis]);
        let (a, b) = ((bounds.min[axis] - origin) * inverse, (bounds.max[axis] - origin) * inverse);
        let (first, last) = if a < b { (a, b) } else { (b, a) };
        near = if first > near { first } else { near };
        far = if last < far { last } else { far };
    }
    (near, far)
}

impl fmt::Display for CameraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "the camera's coordinates must be finite",
            Self::NoDirection => "the camera's eye and target are the same point",
            Self::FieldOfView => "the camera's field of view must lie between 0 and 180 degrees",
            Self::Height => "the height of an orthographic view must be above 0",
        })
    }
}

impl std::error::Error for CameraError {}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(a: DVec3, b: DVec3) -> bool {
        (a - b).length() < 1e-12
    }

    #[test]
    fn fields_of_view_reach_the_edges_of_their_axis() {
        for (axis, edge) in [(FovAxis::Vertical, [100.0, 0.0]), (FovAxis::Horizontal, [0.0, 50.0])] {
            let projection = Projection::Perspective { fov: 1.0, axis };
            let camera = Camera { eye: DVec3::ZERO, target: DVec3::Y, projection, ..Camera::default() };
            let view = View::new(&camera, 200, 100).expect("a camera");
            let ray = view.ray(DVec2::from(edge));
            let angle = ray.direction.angle_between(DVec3::Y);
            assert!((angle - 0.5).abs() < 1e-12, "{axis:?}: {angle}");
            assert!(close(view.ray(DVec2::new(100.0, 50.0)).direction, DVec3::Y));
            assert!(view.ray(DVec2::new(200.0, 50.0)).direction.x > 0.0, "x is on the right");
            assert!(view.ray(DVec2::new(100.0, 0.0)).direction.z > 0.0, "row 0 is on top");
        }
    }

    #[test]
    fn an_orthographic_view_is_as_high_as_told() {
        let projection = Projection::Orthographic { height: 3.0 };
        let camera = Camera { eye: DVec3::ZERO, target: DVec3::Y, projection, ..Camera::default() };
        let view = View::new(&camera, 200, 100).expect("a camera");
        assert!(close(view.ray(DVec2::new(200.0, 100.0)).origin, DVec3::new(3.0, 0.0, -1.5)));
        assert_eq!(view.footprint(), (0.03, 0.0));
    }

    #[test]
    fn looking_along_up_falls_back() {
        for (target, up, right) in [
            (-DVec3::Z, DVec3::Z, DVec3::X),
            (DVec3::Z, DVec3::Z, -DVec3::X),
            (DVec3::Y, DVec3::Y, DVec3::X),
            (DVec3::Y, DVec3::ZERO, DVec3::X),
        ] {
            let camera = Camera { eye: DVec3::ZERO, target, up, ..Camera::default() };
            let view = View::new(&camera, 10, 10).expect("a camera");
            assert!(close(view.right, right), "{target} {up}: {}", view.right);
        }
    }

    #[test]
    fn impossible_cameras_are_refused() {
        let good = Camera::default();
        let lens = |projection| Camera { projection, ..good.clone() };
        for (bad, error) in [
            (Camera { target: good.eye, ..good.clone() }, CameraError::NoDirection),
            (Camera { eye: DVec3::NAN, ..good.clone() }, CameraError::NotFinite),
            (Camera { up: DVec3::INFINITY, ..good.clone() }, CameraError::NotFinite),
            (lens(Projection::Perspective { fov: PI, axis: FovAxis::Vertical }), CameraError::FieldOfView),
            (lens(Projection::Orthographic { height: 0.0 }), CameraError::Height),
        ] {
            assert_eq!(View::new(&bad, 10, 10).err(), Some(error));
        }
    }

    proptest! {
        #[test]
        fn framing_holds_the_box_and_is_tight(
            size in prop::array::uniform3(0.0f64..10.0), center in prop::array::uniform3(-5.0f64..5.0),
            width in 50u32..400,
        ) {
            let (size, center) = (DVec3::from(size) + 0.01, DVec3::from(center));
            let extent = Aabb { min: center - size / 2.0, max: center + size / 2.0 };
            let camera = framed(Some(extent), width, 100);
            let view = View::new(&camera, width, 100).expect("a camera");
            let mut reach = 0.0f64;
            for index in 0..8 {
                let pick = |axis: usize| if index >> axis & 1 == 0 { extent.min } else { extent.max }[axis];
                let corner = DVec3::new(pick(0), pick(1), pick(2)) - camera.eye;
                let depth = corner.dot(view.forward);
                prop_assert!(depth > 0.0);
                let raster = DVec2::new(corner.dot(view.right), corner.dot(view.up)) / depth / view.half;
                reach = reach.max(raster.abs().max_element());
            }
            prop_assert!((reach - FRAMED_SHARE).abs() < 1e-9, "{reach}");
        }
    }
}
