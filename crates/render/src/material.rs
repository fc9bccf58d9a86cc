//! What surfaces look like at a point, and how they reflect light: the models of Phong (1975) and Blinn (1977).
//!
//! Both follow the graphics convention of no 1/pi: a diffuse white surface that faces a light is as bright as the
//! light. All scalar products are clamped at 0, and a highlight needs the light on the front side: without these
//! clamps, light from behind subtracts from the rest or shines through.

use crate::vector::{Triple, add_scaled, dot, length, mix, scaled, times};
use freikugel_scene::{Material, Model, Pattern};
use glam::DVec3;

/// The part of a surface that a ray stands for, for patterns to be averaged over.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint {
    /// The distance to the next ray's line, across both.
    pub(crate) width: f32,
    pub(crate) normal: Triple,
    pub(crate) viewer: Triple,
    /// How far the point may lie from the surface.
    pub(crate) uncertainty: f32,
}

/// The cosine between normal and view that footprints are stretched by at most: beyond it a pattern is an even mean.
const GRAZING: f32 = 1e-3;

/// How far from the surface a pattern in space is looked up, in cells. A surface that coincides with the border of
/// two cells would otherwise show the rounding errors of its points.
const PATTERN_SHIFT: f64 = 1e-4;

/// A material at a point, its patterns evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Surface {
    pub(crate) color: Triple,
    pub(crate) emissive: Triple,
    pub(crate) ambient: f32,
    pub(crate) diffuse: f32,
    pub(crate) specular: f32,
    pub(crate) exponent: f32,
    pub(crate) model: Model,
}

impl Surface {
    /// The material at a point of the world, averaged over the part of the surface around it.
    pub(crate) fn of(material: &Material, point: DVec3, footprint: &Footprint) -> Self {
        let color = match material.color {
            Pattern::Solid(color) => color,
            Pattern::Checker { colors: [even, odd], size } => mix(even, odd, odd_share(point, size, footprint)),
        };
        let &Material { emissive, ambient, diffuse, specular, exponent, model, .. } = material;
        Self { color, emissive, ambient, diffuse, specular, exponent, model }
    }

    /// Moves all channels towards those of `other`, by a share from 0 to 1. The model is a matter of kind, not of
    /// degree: the larger share's counts.
    pub(crate) fn mix(&mut self, other: &Self, share: f32) {
        let blend = |a: f32, b: f32| a + (b - a) * share;
        *self = Self {
            color: mix(self.color, other.color, share),
            emissive: mix(self.emissive, other.emissive, share),
            ambient: blend(self.ambient, other.ambient),
            diffuse: blend(self.diffuse, other.diffuse),
            specular: blend(self.specular, other.specular),
            exponent: blend(self.exponent, other.exponent),
            model: if share > 0.5 { other.model } else { self.model },
        };
    }

    /// The light that leaves towards `viewer` of what arrives from the direction `to_light`, of which `normal` makes an
    /// angle with cosine `n_dot_l` above 0. All directions are unit vectors away from the surface.
    pub(crate) fn reflected(
        &self,
        light: Triple,
        normal: Triple,
        viewer: Triple,
        to_light: Triple,
        n_dot_l: f32,
    ) -> Triple {
        let highlight = if self.specular > 0.0 {
            let cosine = match self.model {
                Model::Phong => {
                    let mirrored = add_scaled(scaled(normal, 2.0 * n_dot_l), -1.0, to_light);
                    dot(mirrored, viewer)
                }
                Model::BlinnPhong => {
                    let between = add_scaled(to_light, 1.0, viewer);
                    // Light from exactly behind the surface's point has no direction between.
                    dot(normal, between) / length(between).max(f32::MIN_POSITIVE)
                }
            };
            self.specular * power(cosine.clamp(0.0, 1.0), self.exponent)
        } else {
            0.0
        };
        let body = scaled(self.color, self.diffuse * n_dot_l);
        times(light, body.map(|channel| channel + highlight))
    }
}

impl Footprint {
    /// The extents along the axes of the ellipse that a ray's round cross-section leaves on the surface.
    fn extents(&self) -> Triple {
        let cosine = dot(self.normal, self.viewer);
        let downhill = add_scaled(self.viewer, -cosine, self.normal);
        // The ellipse reaches as far as the cross-section across the slope and 1 / cosine times as far along it. Squared:
        // all directions in the plane, plus what the slope's direction has more. That direction is `downhill` over its
        // length, which is the sine, so sin^2 * (1 / cos^2 - 1) / sin^2 = (1 - cos^2) / cos^2 / sin^2 = 1 / cos^2.
        let stretch = 1.0 / (cosine * cosine).max(GRAZING * GRAZING);
        std::array::from_fn(|axis| {
            let in_plane = 1.0 - self.normal[axis] * self.normal[axis];
            let more = downhill[axis] * downhill[axis] * stretch;
            self.width * (in_plane.max(0.0) + more).sqrt()
        })
    }
}

/// The part of the odd cells of a checker pattern in a footprint.
///
/// A checker pattern is the product of three square waves of values 1 and -1, hence its mean over a box is the product
/// of three means, each from the wave's integral, a triangle wave. The box around the ellipse stands for the ellipse.
fn odd_share(point: DVec3, size: f64, footprint: &Footprint) -> f32 {
    let shift = 2.0 * f64::from(footprint.uncertainty) + PATTERN_SHIFT * size;
    let extents = footprint.extents();
    let mean = (0..3).map(|axis| {
        let middle = (point[axis] + f64::from(footprint.normal[axis]) * shift) / size;
        let width = f64::from(extents[axis]) / size;
        if width < PATTERN_SHIFT {
            1.0 - 2.0 * modulo2(middle.floor())
        } else {
            let integral = |x: f64| 1.0 - (modulo2(x) - 1.0).abs();
            (integral(middle + width / 2.0) - integral(middle - width / 2.0)) / width
        }
    });
    (0.5 - 0.5 * mean.product::<f64>()) as f32
}

/// `x` less the largest even number below; cheaper than the general remainder.
#[inline]
fn modulo2(x: f64) -> f64 {
    x - 2.0 * (x * 0.5).floor()
}

/// The largest whole exponent that is multiplied out: up to there it is faster than a logarithm and an exponential.
const MOST_FACTORS: f32 = 1024.0;

/// `base^exponent` for a base between 0 and 1.
fn power(base: f32, exponent: f32) -> f32 {
    if exponent != exponent.trunc() || !(0.0..=MOST_FACTORS).contains(&exponent) {
        return libm::powf(base, exponent);
    }
    // By repeated squaring, whose factors stay in order, so that all machines agree.
    let (mut square, mut product, mut rest) = (base, 1.0, exponent as u32);
    while rest != 0 {
        if rest & 1 == 1 {
            product *= square;
        }
        square *= square;
        rest >>= 1;
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Triple = [0.0, 0.0, 1.0];

    fn unit(v: Triple) -> Triple {
        scaled(v, 1.0 / length(v))
    }

    fn plain(model: Model) -> Surface {
        let material = Material {
            color: Pattern::Solid([0.5, 0.25, 1.0]),
            diffuse: 0.5,
            specular: 0.25,
            exponent: 8.0,
            model,
            ..Material::default()
        };
        Surface::of(&material, DVec3::ZERO, &sharp(0.0))
    }

    fn sharp(uncertainty: f32) -> Footprint {
        Footprint { width: 0.0, normal: UP, viewer: UP, uncertainty }
    }

    #[test]
    fn the_models_agree_with_their_textbook_form() {
        let light = unit([0.3, 0.1, 0.9]);
        let viewer = unit([-0.5, 0.2, 0.7]);
        // Mirroring at the plane z = 0 turns x and y round.
        let phong = dot([-light[0], -light[1], light[2]], viewer).powi(8);
        let blinn = unit(add_scaled(light, 1.0, viewer))[2].powi(8);
        for (model, cosine) in [(Model::Phong, phong), (Model::BlinnPhong, blinn)] {
            let out = plain(model).reflected([1.0, 2.0, 4.0], UP, viewer, light, light[2]);
            for (channel, (color, power)) in [(0.5, 1.0), (0.25, 2.0), (1.0, 4.0)].into_iter().enumerate() {
                let expected = power * (0.5 * color * light[2] + 0.25 * cosine);
                assert!((out[channel] - expected).abs() < 1e-6, "{model:?} {channel}");
            }
        }
    }

    #[test]
    fn a_mirrored_ray_that_misses_the_viewer_takes_nothing_away() {
        let (light, viewer) = (unit([1.0, 0.0, 0.2]), unit([1.0, 0.0, 0.2]));
        let out = plain(Model::Phong).reflected([1.0; 3], UP, viewer, light, light[2]);
        let body = 0.5 * light[2];
        assert!((out[2] - body).abs() < 1e-6, "{out:?}");
        // Light from below the viewer's own line of sight: no direction between, but a number.
        let out = plain(Model::BlinnPhong).reflected([1.0; 3], UP, UP, [0.0, 0.0, -1.0], 0.1);
        assert!(out.iter().all(|c| c.is_finite()));
    }

    #[test]
    fn checkers_alternate_and_do_not_flicker_on_the_border_of_cells() {
        let colors = [[1.0; 3], [0.0; 3]];
        let material = Material { color: Pattern::Checker { colors, size: 0.5 }, ..Material::default() };
        let at = |x: f64, y: f64, z: f64| Surface::of(&material, DVec3::new(x, y, z), &sharp(1e-5)).color[0];
        assert_eq!([at(0.1, 0.1, 0.1), at(0.6, 0.1, 0.1)], [1.0, 0.0]);
        assert_eq!([at(0.6, 0.6, 0.1), at(0.6, 0.6, 0.6)], [1.0, 0.0]);
        assert_eq!([at(-0.1, 0.1, 0.1), at(-0.1, -0.1, 0.1)], [0.0, 1.0]);
        for noise in [-1e-5, -1e-9, 0.0, 1e-9, 1e-5] {
            assert_eq!(at(0.1, 0.1, noise), 1.0);
            assert_eq!(at(0.1, 0.1, 0.5 + noise), 0.0);
        }
    }

    #[test]
    fn a_footprint_holds_the_mean_of_what_it_covers() {
        // Points of the pattern spread over the box around the footprint, seen at 60 degrees along x.
        let viewer = [0.75f32.sqrt(), 0.0, 0.5];
        for width in [0.01f32, 0.2, 0.7, 3.0] {
            let footprint = Footprint { width, normal: UP, viewer, uncertainty: 0.0 };
            let [along, across, up] = footprint.extents();
            assert!((along / width - 2.0).abs() < 1e-5 && (across / width - 1.0).abs() < 1e-5);
            assert_eq!(up, 0.0);
            for point in [DVec3::new(0.3, 0.4, 0.0), DVec3::new(0.98, -1.03, 0.0)] {
                let steps = 400;
                let place =
                    |step: i32, width: f32| (f64::from(step) + 0.5) / 400.0 * f64::from(width) - f64::from(width) / 2.0;
                let odd = (0..steps)
                    .flat_map(|i| (0..steps).map(move |j| (i, j)))
                    .filter(|&(i, j)| {
                        let (x, y) = (point.x + place(i, along), point.y + place(j, across));
                        (x.floor() + y.floor()).rem_euclid(2.0) == 1.0
                    })
                    .count();
                let expected = odd as f32 / 160_000.0;
                let share = odd_share(point, 1.0, &footprint);
                assert!((share - expected).abs() < 0.01, "{width} {point}: {share} {expected}");
            }
        }
    }

    #[test]
    fn mixing_ends_at_either_material() {
        let (a, b) = (plain(Model::Phong), Surface { exponent: 2.0, color: [0.0; 3], ..plain(Model::BlinnPhong) });
        for (share, expected) in [(0.0, a), (1.0, b)] {
            let mut mixed = a;
            mixed.mix(&b, share);
            assert_eq!(mixed, expected);
        }
    }
}
