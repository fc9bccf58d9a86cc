//! Lights as surfaces see them: from where, how much, and what may stand in between.

use crate::vector::{Triple, dot, length, scaled};
use freikugel_scene::{Falloff, Light, Rgb, Shadow};
use glam::DVec3;
use std::f64::consts::PI;

/// The apparent diameter of the sun as seen from the earth, in radians: that of a sun with a penumbra that names none.
const SUN_DIAMETER: f64 = 0.009_31;

/// The shortest distance to a light that its intensity is divided by; no picture shows a point closer to one.
const NEAREST: f32 = 1e-6;

/// Where light comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Emitter {
    /// From one direction, from afar.
    Sun { direction: Triple },
    /// From a point, into all directions or into a cone.
    Point { position: Triple, falloff: Falloff, cone: Option<Cone> },
}

/// The cone of a spot light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    pub(crate) axis: Triple,
    /// Cosines of the angles where the light ends and where it begins to fade.
    pub(crate) outer: f32,
    pub(crate) inner: f32,
}

/// What dims a light where something stands in between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Dimming {
    /// Nothing does.
    None,
    /// All or nothing.
    Hard,
    /// The least ratio of clearance to distance from the surface, times this, up to 1.
    Sharpness(f32),
    /// As before; the factor is the distance to the light over the light's own clearance, which is this.
    Clearance(f32),
}

/// A light made ready for shading: relative to the picture's origin, in single precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lamp {
    pub(crate) emitter: Emitter,
    pub(crate) power: Rgb,
    pub(crate) dimming: Dimming,
}

/// Light on its way to a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Incoming {
    /// The unit vector towards the light.
    pub(crate) direction: Triple,
    /// How far it is; infinite for a sun.
    pub(crate) distance: f32,
    /// What arrives on a surface that faces it, if nothing stands in between.
    pub(crate) light: Triple,
}

impl Lamp {
    /// Makes a light ready. `clearance` is the distance from a point of the world to the nearest surface.
    ///
    /// # Errors
    /// What is wrong with the light, as a sentence.
    pub(crate) fn new(light: &Light, origin: DVec3, clearance: impl Fn(DVec3) -> f64) -> Result<Self, &'static str> {
        let unit = |v: DVec3, fault| v.try_normalize().map(|v| v.as_vec3().to_array()).ok_or(fault);
        let (emitter, place, color, intensity, shadow) = match light {
            Light::Sun(sun) => {
                let direction = unit(sun.direction, "the direction of a sun must not be the zero vector")?;
                (Emitter::Sun { direction }, None, sun.color, sun.intensity, sun.shadow)
            }
            Light::Point(point) => {
                let emitter = Emitter::Point {
                    position: (point.position - origin).as_vec3().to_array(),
                    falloff: point.falloff,
                    cone: None,
                };
                (emitter, Some(point.position), point.color, point.intensity, point.shadow)
            }
            Light::Spot(spot) => {
                if !(spot.angle > 0.0 && spot.angle <= PI) {
                    return Err("the angle of a spot light must lie between 0 and 180 degrees");
                }
                let fault = "a spot light must not stand at its target";
                let half = spot.angle / 2.0;
                let cone = Cone {
                    axis: unit(spot.target - spot.position, fault)?,
                    outer: libm::cos(half) as f32,
                    inner: libm::cos(half * (1.0 - spot.softness.clamp(0.0, 1.0))) as f32,
                };
                let emitter = Emitter::Point {
                    position: (spot.position - origin).as_vec3().to_array(),
                    falloff: spot.falloff,
                    cone: Some(cone),
                };
                (emitter, Some(spot.position), spot.color, spot.intensity, spot.shadow)
            }
        };
        if place.is_some_and(|place| !place.is_finite()) || !intensity.is_finite() {
            return Err("a light's position and intensity must be finite");
        }
        let dimming = match (shadow, place) {
            (Shadow::None, _) => Dimming::None,
            (Shadow::Hard, _) => Dimming::Hard,
            (Shadow::Hardness(hardness), _) if hardness > 0.0 => match hardness.is_finite() {
                true => Dimming::Sharpness(hardness),
                false => Dimming::Hard,
            },
            (Shadow::Hardness(_), _) => return Err("the hardness of a shadow must be above 0"),
            (Shadow::Clearance { .. }, Some(place)) => match clearance(place) {
                // A light inside something has no clearance, and lights nothing outside.
                inside if inside <= 0.0 => Dimming::Hard,
                free => Dimming::Clearance(free as f32),
            },
            (Shadow::Clearance { angle }, None) => match angle.unwrap_or(SUN_DIAMETER) {
                angle if angle <= 0.0 => Dimming::Hard,
                angle if angle <= PI => Dimming::Sharpness((1.0 / libm::tan(angle / 2.0)) as f32),
                _ => return Err("a sun must not be wider than 180 degrees"),
            },
        };
        Ok(Self { emitter, power: scaled(color, intensity), dimming })
    }

    /// The light that arrives at `point` if nothing stands in between; `None` if that is nothing at all.
    #[inline]
    pub(crate) fn at(&self, point: Triple) -> Option<Incoming> {
        let (position, falloff, cone) = match self.emitter {
            Emitter::Sun { direction } => {
                return Some(Incoming { direction, distance: f32::INFINITY, light: self.power });
            }
            Emitter::Point { position, falloff, cone } => (position, falloff, cone),
        };
        let way = [position[0] - point[0], position[1] - point[1], position[2] - point[2]];
        let distance = length(way).max(NEAREST);
        let direction = scaled(way, 1.0 / distance);
        let falloff = match falloff {
            Falloff::None => 1.0,
            Falloff::InverseSquare => 1.0 / (distance * distance),
            Falloff::Polynomial([c0, c1, c2]) => 1.0 / (c0 + distance * (c1 + distance * c2)).max(NEAREST),
        };
        let share = cone.map_or(1.0, |cone| cone.share(-dot(direction, cone.axis)));
        (share > 0.0).then(|| Incoming { direction, distance, light: scaled(self.power, falloff * share) })
    }
}

impl Cone {
    /// How much of the light goes into a direction at an angle with this cosine to the axis.
    fn share(self, cosine: f32) -> f32 {
        if cosine >= self.inner {
            // Also where the cone has no soft edge.
            1.0
        } else {
            let t = ((cosine - self.outer) / (self.inner - self.outer)).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use freikugel_scene::{Point, Spot, Sun};

    const ORIGIN: DVec3 = DVec3::new(0.5, 0.0, -2.0);

    fn lamp(light: &Light) -> Lamp {
        Lamp::new(light, ORIGIN, |_| 0.25).expect("a sound light")
    }

    fn at(light: &Light, point: DVec3) -> f32 {
        lamp(light).at((point - ORIGIN).as_vec3().to_array()).map_or(0.0, |incoming| incoming.light[0])
    }

    #[test]
    fn light_falls_off_as_told() {
        let at_distance_4 = |falloff| {
            let point = Point { position: DVec3::Z * 3.0, intensity: 8.0, falloff, ..Point::default() };
            at(&Light::Point(point), -DVec3::Z)
        };
        assert_eq!(at_distance_4(Falloff::None), 8.0);
        assert_eq!(at_distance_4(Falloff::InverseSquare), 0.5);
        assert_eq!(at_distance_4(Falloff::Polynomial([1.0, 0.5, 0.0625])), 2.0);
        assert!(at_distance_4(Falloff::Polynomial([0.0; 3])).is_finite());
    }

    #[test]
    fn a_point_light_shines_from_where_it_is() {
        let light = Light::Point(Point { position: DVec3::new(3.0, 4.0, 0.0), ..Point::default() });
        let incoming = lamp(&light).at((DVec3::ZERO - ORIGIN).as_vec3().to_array()).expect("light");
        assert!((incoming.distance - 5.0).abs() < 1e-6);
        assert!((incoming.direction[0] - 0.6).abs() < 1e-6 && (incoming.direction[1] - 0.8).abs() < 1e-6);
        let own = lamp(&light).at((DVec3::new(3.0, 4.0, 0.0) - ORIGIN).as_vec3().to_array());
        assert!(own.is_some_and(|incoming| incoming.light.iter().all(|c| c.is_finite())));
    }

    #[test]
    fn a_spot_fades_between_its_angles() {
        let spot = Spot {
            position: DVec3::Z,
            target: DVec3::ZERO,
            angle: PI / 2.0,
            softness: 0.5,
            falloff: Falloff::None,
            ..Spot::default()
        };
        let light = |softness| Light::Spot(Spot { softness, ..spot.clone() });
        let degrees = |angle: f64| DVec3::new(angle.to_radians().tan(), 0.0, 0.0);
        assert_eq!(at(&light(0.5), degrees(22.0)), 1.0);
        assert_eq!(at(&light(0.5), degrees(45.5)), 0.0);
        let middle = (22.5f64.to_radians().cos() + 45f64.to_radians().cos()) / 2.0;
        assert!((at(&light(0.5), degrees(middle.acos().to_degrees())) - 0.5).abs() < 1e-3);
        assert_eq!([at(&light(0.0), degrees(44.9)), at(&light(0.0), degrees(45.1))], [1.0, 0.0]);
        assert_eq!(at(&light(0.5), DVec3::Z * 2.0), 0.0, "nothing shines backwards");
    }

    #[test]
    fn shadows_become_a_dimming() {
        let sun = |shadow| lamp(&Light::Sun(Sun { shadow, ..Sun::default() })).dimming;
        let point = |shadow| lamp(&Light::Point(Point { shadow, ..Point::default() })).dimming;
        assert_eq!(sun(Shadow::None), Dimming::None);
        assert_eq!(sun(Shadow::Hardness(8.0)), Dimming::Sharpness(8.0));
        assert_eq!(sun(Shadow::Hardness(f32::INFINITY)), Dimming::Hard);
        assert_eq!(point(Shadow::Clearance { angle: None }), Dimming::Clearance(0.25));
        let Dimming::Sharpness(sharpness) = sun(Shadow::Clearance { angle: Some(PI / 2.0) }) else {
            panic!("a sun's clearance is an angle")
        };
        assert!((sharpness - 1.0).abs() < 1e-6);
    }

    #[test]
    fn impossible_lights_are_refused() {
        let sun = Sun { direction: DVec3::ZERO, ..Sun::default() };
        let dark = Sun { shadow: Shadow::Hardness(0.0), ..Sun::default() };
        let spot = Spot { position: DVec3::ONE, target: DVec3::ONE, ..Spot::default() };
        let wide = Spot { angle: 4.0, ..Spot::default() };
        let lost = Point { position: DVec3::NAN, ..Point::default() };
        for light in [Light::Sun(sun), Light::Sun(dark), Light::Spot(spot), Light::Spot(wide), Light::Point(lost)] {
            assert!(Lamp::new(&light, DVec3::ZERO, |_| 1.0).is_err(), "{light:?}");
        }
    }
}
