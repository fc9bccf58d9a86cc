//! Moving a camera by mouse and keys: around a point, or flying.
//!
//! Around a point, the world's vertical stays vertical, and the eye stops short of the poles. Panning moves what lies at
//! the target's distance with the mouse, exactly. Flying turns the view about the eye; its speed is in distances to the
//! target, so that small and large scenes feel alike. Nothing here knows windows or keys.

use freikugel_scene::{Camera, FovAxis, Projection};
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::PI;

/// How far a drag over the height of the window turns the camera.
const TURN_PER_HEIGHT: f64 = PI;

/// The smallest angle between the view and the vertical.
const POLE: f64 = 0.01;

/// What one notch of the wheel multiplies the distance to the target with, nearer.
const ZOOM_PER_NOTCH: f64 = 0.9;

/// What one notch of the wheel multiplies the speed with.
const SPEED_PER_NOTCH: f64 = 1.2;

/// Distances to the target that are flown in a second at first.
const SPEED: f64 = 0.5;

/// The slowest and the fastest flight, in distances to the target per second.
const SPEEDS: [f64; 2] = [0.005, 50.0];

/// The nearest and the farthest target, relative to where it was at first; beyond, single precision shows.
const RANGE: [f64; 2] = [1e-4, 1e4];

/// How the mouse and keys move the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Mode {
    /// Around the target.
    #[default]
    Orbit,
    /// Freely, looking around.
    Fly,
}

/// A camera that is moved.
#[derive(Clone, Debug)]
pub(crate) struct Controller {
    camera: Camera,
    home: Camera,
    vertical: DVec3,
    mode: Mode,
    speed: f64,
}

impl Controller {
    /// Starts with a camera, whose `up` becomes the vertical.
    pub(crate) fn new(camera: Camera) -> Self {
        let vertical = camera.up.try_normalize().unwrap_or(DVec3::Z);
        Self { home: camera.clone(), camera, vertical, mode: Mode::Orbit, speed: SPEED }
    }

    /// The camera as it stands.
    pub(crate) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// How the camera moves.
    pub(crate) fn mode(&self) -> Mode {
        self.mode
    }

    /// Orbit becomes flight and back. The camera stays where it is.
    pub(crate) fn toggle_mode(&mut self) {
        self.mode = match self.mode {
            Mode::Orbit => Mode::Fly,
            Mode::Fly => Mode::Orbit,
        };
    }

    /// Back to where it was at first.
    pub(crate) fn reset(&mut self) {
        self.camera = self.home.clone();
        self.speed = SPEED;
    }

    /// Takes another camera as the one to go back to, and moves there unless the user has moved the old one.
    pub(crate) fn set_home(&mut self, home: Camera) {
        if self.camera == self.home {
            self.camera = home.clone();
            self.vertical = home.up.try_normalize().unwrap_or(DVec3::Z);
        }
        self.home = home;
    }

    /// A drag by some pixels in a window of some height: turns about the target or, flying, about the eye.
    pub(crate) fn turn(&mut self, drag: DVec2, height: f64) {
        let angles = drag / height * TURN_PER_HEIGHT;
        let to_target = self.camera.target - self.camera.eye;
        let around = DQuat::from_axis_angle(self.vertical, -angles.x);
        let right = around * self.right();
        let polar = to_target.angle_between(self.vertical);
        // Down is away from the vertical, whatever is turned.
        let tip = (polar + angles.y).clamp(POLE, PI - POLE) - polar;
        let turned = DQuat::from_axis_angle(right, -tip) * (around * to_target);
        match self.mode {
            Mode::Orbit => self.camera.eye = self.camera.target - turned,
            Mode::Fly => self.camera.target = self.camera.eye + turned,
        }
    }

    /// A drag by some pixels in a window of some size: moves the camera sideways so that what lies at the target's distance
    /// follows the mouse.
    pub(crate) fn pan(&mut self, drag: DVec2, size: DVec2) {
        let right = self.right();
        let forward = self.forward();
        let up = right.cross(forward);
        let shift = (up * drag.y - right * drag.x) * self.world_per_pixel(size);
        self.camera.eye += shift;
        self.camera.target += shift;
    }

    /// Notches of the wheel, away from the user if positive: nearer to the target; flying, faster.
    pub(crate) fn zoom(&mut self, notches: f64) {
        if self.mode == Mode::Fly {
            self.speed = (self.speed * SPEED_PER_NOTCH.powf(notches)).clamp(SPEEDS[0], SPEEDS[1]);
            return;
        }
        let factor = ZOOM_PER_NOTCH.powf(notches);
        if let Projection::Orthographic { height } = &mut self.camera.projection {
            let [least, most] = RANGE;
            let home = match self.home.projection {
                Projection::Orthographic { height } => height,
                Projection::Perspective { .. } => *height,
            };
            *height = (*height * factor).clamp(home * least, home * most);
            return;
        }
        let distance = self.distance();
        let home = (self.home.target - self.home.eye).length();
        let wanted = (distance * factor).clamp(home * RANGE[0], home * RANGE[1]);
        self.camera.eye = self.camera.target - self.forward() * wanted;
    }

    /// Moves for some time in the directions that keys name: x to the right, y forward, z along the vertical, each -1, 0 or 1.
    pub(crate) fn fly(&mut self, direction: DVec3, seconds: f64) {
        let along = self.right() * direction.x + self.forward() * direction.y + self.vertical * direction.z;
        let shift = along.normalize_or_zero() * (self.speed * self.distance() * seconds);
        self.camera.eye += shift;
        self.camera.target += shift;
    }

    fn distance(&self) -> f64 {
        (self.camera.target - self.camera.eye).length()
    }

    fn forward(&self) -> DVec3 {
        (self.camera.target - self.camera.eye).normalize_or(DVec3::Y)
    }

    /// To the right; where the view is vertical, any direction that is level.
    fn right(&self) -> DVec3 {
        let level = self.forward().cross(self.vertical);
        level.try_normalize().unwrap_or_else(|| self.vertical.any_orthonormal_vector())
    }

    /// The width of a pixel at the target's distance.
    fn world_per_pixel(&self, size: DVec2) -> f64 {
        match self.camera.projection {
            Projection::Orthographic { height } => height / size.y,
            Projection::Perspective { fov, axis } => {
                let pixels = match axis {
                    FovAxis::Vertical => size.y,
                    FovAxis::Horizontal => size.x,
                };
                2.0 * (fov / 2.0).tan() * self.distance() / pixels
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HEIGHT: f64 = 400.0;
    const SIZE: DVec2 = DVec2::new(600.0, HEIGHT);

    fn controller() -> Controller {
        Controller::new(Camera::look([4, -6, 3], [1, 0, 1]))
    }

    /// Where a point falls in the window, in pixels from its middle: right and up.
    fn raster(camera: &Camera, point: DVec3) -> DVec2 {
        let Projection::Perspective { fov, axis: FovAxis::Vertical } = camera.projection else {
            panic!("not the lens of this test");
        };
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let up = right.cross(forward);
        let seen = point - camera.eye;
        DVec2::new(seen.dot(right), seen.dot(up)) / seen.dot(forward) / (fov / 2.0).tan() * (HEIGHT / 2.0)
    }

    proptest! {
        #[test]
        fn orbits_keep_target_distance_and_vertical(
            drags in prop::collection::vec(prop::array::uniform2(-300.0f64..300.0), 1..20),
        ) {
            let mut controller = controller();
            let (target, distance) = (controller.camera().target, controller.distance());
            for drag in drags {
                controller.turn(drag.into(), HEIGHT);
                prop_assert_eq!(controller.camera().target, target);
                prop_assert!((controller.distance() - distance).abs() < 1e-9);
                let polar = (target - controller.camera().eye).angle_between(DVec3::Z);
                prop_assert!(polar > 0.9 * POLE && polar < PI - 0.9 * POLE, "{}", polar);
            }
        }

        #[test]
        fn flight_turns_about_the_eye(drags in prop::collection::vec(prop::array::uniform2(-300.0f64..300.0), 1..20)) {
            let mut controller = controller();
            controller.toggle_mode();
            let (eye, distance) = (controller.camera().eye, controller.distance());
            for drag in drags {
                controller.turn(drag.into(), HEIGHT);
                prop_assert_eq!(controller.camera().eye, eye);
                prop_assert!((controller.distance() - distance).abs() < 1e-9);
            }
        }

        #[test]
        fn the_target_follows_the_mouse(x in -200.0f64..200.0, y in -200.0f64..200.0) {
            let mut controller = controller();
            let target = controller.camera().target;
            controller.pan(DVec2::new(x, y), SIZE);
            // Window coordinates point down.
            let moved = raster(controller.camera(), target);
            prop_assert!((moved - DVec2::new(x, -y)).length() < 1e-6, "{}", moved);
        }

        #[test]
        fn zooming_in_and_out_leads_back(notches in -20.0f64..20.0) {
            let mut controller = controller();
            let (eye, distance) = (controller.camera().eye, controller.distance());
            controller.zoom(notches);
            prop_assert!((controller.distance() / distance - ZOOM_PER_NOTCH.powf(notches)).abs() < 1e-9);
            controller.zoom(-notches);
            prop_assert!((controller.camera().eye - eye).length() < 1e-9);
        }
    }

    #[test]
    fn the_scene_turns_with_the_mouse() {
        // What is in front of the target follows a drag to the right, and one down.
        let mut controller = controller();
        let camera = controller.camera().clone();
        let front = camera.target + (camera.eye - camera.target) * 0.2;
        controller.turn(DVec2::new(20.0, 0.0), HEIGHT);
        assert!(raster(controller.camera(), front).x > 1.0);
        controller.reset();
        assert_eq!(controller.camera(), &camera);
        controller.turn(DVec2::new(0.0, 20.0), HEIGHT);
        assert!(raster(controller.camera(), front).y < -1.0);
    }

    #[test]
    fn keys_fly_where_they_say() {
        let mut controller = controller();
        let (eye, distance) = (controller.camera().eye, controller.distance());
        controller.fly(DVec3::Y, 0.5);
        let forward = (controller.camera().target - controller.camera().eye).normalize();
        assert!((controller.camera().eye - eye - forward * (0.5 * SPEED * distance)).length() < 1e-9);
        controller.reset();
        controller.fly(DVec3::Z, 1.0);
        assert!((controller.camera().eye - eye - DVec3::Z * (SPEED * distance)).length() < 1e-9);
        controller.reset();
        controller.fly(DVec3::ZERO, 1.0);
        assert_eq!(controller.camera().eye, eye);
    }

    #[test]
    fn a_new_home_moves_only_those_who_have_not_moved() {
        let mut controller = controller();
        let other = Camera::look([1, 1, 1], [0, 0, 0]);
        controller.set_home(other.clone());
        assert_eq!(controller.camera(), &other);
        controller.zoom(1.0);
        let moved = controller.camera().clone();
        controller.set_home(Camera::look([9, 9, 9], [0, 0, 0]));
        assert_eq!(controller.camera(), &moved);
    }

    #[test]
    fn views_along_the_vertical_can_be_left() {
        let mut controller = Controller::new(Camera::look([0, 0, 5], [0, 0, 0]));
        controller.turn(DVec2::new(3.0, -40.0), HEIGHT);
        assert!(controller.camera().eye.is_finite());
        assert!((controller.distance() - 5.0).abs() < 1e-9);
    }
}
