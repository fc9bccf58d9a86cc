//! Over-relaxed sphere tracing (Keinert, Schäfer, Korndörfer, Ganse and Stamminger, "Enhanced Sphere Tracing", 2014).
//!
//! A step goes farther than the free distance, in the hope that the sphere at its end still touches the one it left: then
//! the two together cover the way, and no surface was passed. If they part, the ray goes back to the end of the free
//! distance, and takes ordinary steps from there on. The paper compares the sizes of both spheres with the step; here the
//! second one counts with its sign, so that a step into a solid is always taken back, and they must overlap by more than
//! rounding errors.

use crate::march::{End, Fate, Pace, Start};
use crate::prepare::rounding;
use crate::vector::{add_scaled, length};
use freikugel_field::{Evaluator, Part, Points};

/// The rays on their way.
#[derive(Default)]
pub(crate) struct Relaxed {
    rays: Vec<Runner>,
    point: [Vec<f32>; 3],
    value: Vec<f32>,
}

/// A ray.
#[derive(Clone, Copy)]
struct Runner {
    start: Start,
    t: f32,
    steps: u32,
    relaxation: f32,
    /// The free distance where the last step began, and how far that went.
    before: f32,
    step: f32,
}

impl Relaxed {
    /// Takes all rays to their first surface. Appends how they ended, in no particular order, and returns how many field
    /// values that took.
    pub(crate) fn run(
        &mut self,
        field: &mut Evaluator<'_>,
        part: &Part,
        pace: Pace,
        relaxation: f32,
        starts: &[Start],
        ends: &mut Vec<End>,
    ) -> u64 {
        let Self { rays, point, value } = self;
        rays.extend(starts.iter().map(|start| Runner {
            start: *start,
            t: start.span[0],
            steps: start.steps,
            relaxation,
            before: 0.0,
            step: 0.0,
        }));
        let mut evaluations = 0;
        while !rays.is_empty() {
            point.iter_mut().for_each(Vec::clear);
            for Runner { start, t, .. } in &*rays {
                let place = add_scaled(start.origin, *t, start.direction);
                point.iter_mut().zip(place).for_each(|(numbers, number)| numbers.push(number));
            }
            value.resize(rays.len(), 0.0);
            let [x, y, z] = &*point;
            field.values_in(part, Points { x, y, z }, value);
            evaluations += rays.len() as u64;
            let mut values = value.iter();
            rays.retain_mut(|ray| {
                let value = *values.next().expect("a value for each ray");
                let Some(fate) = ray.advance(value, pace) else { return true };
                let (start, factor) = (&ray.start, if fate == Fate::Hit { 0.0 } else { 1.0 });
                let (t, steps, place) = (ray.t, ray.steps, End::NOWHERE);
                ends.push(End { id: start.id, fate, t, value, steps, factor, place });
                false
            });
        }
        evaluations
    }
}

impl Runner {
    /// Takes a step, knowing the field where the ray is; or says how it ended.
    fn advance(&mut self, value: f32, pace: Pace) -> Option<Fate> {
        let Start { span: [_, end], tolerance: [base, growth], .. } = self.start;
        let free = value * pace.scale;
        let is_exhausted = self.steps >= pace.max_steps || free.is_nan();
        // The sphere that the ray left covers ordinary steps alone.
        let margin = rounding(length(self.start.origin) + self.t);
        if self.step > self.before && self.before + free < self.step + margin {
            let ordinary = self.before * pace.step_factor;
            self.t += ordinary - self.step;
            (self.step, self.relaxation) = (ordinary, 1.0);
        } else if value < base + growth * self.t {
            return Some(Fate::Hit);
        } else if self.t + free >= end {
            self.t = end;
            return Some(Fate::Passed);
        } else if !is_exhausted {
            // Not past the end: what the last sphere does not cover would be left unseen.
            self.step = (free * pace.step_factor * self.relaxation).min(end - self.t);
            self.before = free;
            self.t += self.step;
        }
        self.steps += u32::from(!is_exhausted);
        is_exhausted.then_some(Fate::Exhausted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use freikugel_field::{Field, Structure, shapes::*};

    /// A ray along x that begins at 0.
    fn start(id: u32, end: f32) -> Start {
        Start {
            id,
            origin: [0.0, 0.01 * id as f32, 0.0],
            direction: [1.0, 0.0, 0.0],
            span: [0.0, end],
            tolerance: [1e-4, 0.0],
            steps: 0,
            sharpness: 1.0,
        }
    }

    fn run(field: Field, relaxation: f32, starts: &[Start]) -> (Vec<End>, u64) {
        let structure = Structure::compile(&[field]).expect("a sound field");
        let program = structure.program(glam::DVec3::ZERO);
        let mut evaluator = Evaluator::new(&program);
        let pace = Pace { scale: 1.0, step_factor: 1.0, max_steps: 1000 };
        let mut ends = Vec::new();
        let mut relaxed = Relaxed::default();
        let evaluations = relaxed.run(&mut evaluator, program.whole(), pace, relaxation, starts, &mut ends);
        ends.sort_unstable_by_key(|end| end.id);
        (ends, evaluations)
    }

    #[test]
    fn plates_thinner_than_a_step_are_not_jumped_over() {
        // A long way on which the free distance is large, then a plate far thinner than the surplus of a relaxed step.
        for relaxation in [1.0, 1.2, 1.6, 1.99] {
            for distance in [1.0, 3.7, 10.0, 55.5] {
                let plate = cuboid([0.001, 50.0, 50.0]).at([distance, 0.0, 0.0]);
                let starts: Vec<Start> = (0..50).map(|id| start(id, 200.0)).collect();
                for end in run(plate, relaxation, &starts).0 {
                    assert_eq!(end.fate, Fate::Hit, "{relaxation} {distance}");
                    let overshoot = f64::from(end.t) - (distance - 0.0005);
                    assert!(overshoot < 1e-4 && overshoot > -2e-4, "{relaxation} {distance}: {overshoot}");
                }
            }
        }
    }

    #[test]
    fn a_surface_just_before_the_end_is_found_and_one_just_behind_is_not() {
        let plate = || cuboid([0.002, 50.0, 50.0]).at([10.0, 0.0, 0.0]);
        for relaxation in [1.0, 1.5, 1.9] {
            let fates: Vec<Fate> = [9.998, 10.0].map(|end| run(plate(), relaxation, &[start(0, end)]).0[0].fate).into();
            assert_eq!(fates, [Fate::Passed, Fate::Hit], "{relaxation}");
        }
    }

    #[test]
    fn rays_along_a_wall_take_fewer_steps() {
        let wall = || cuboid([100.0, 1.0, 1.0]).at([50.0, -1.0, 0.0]);
        let starts: Vec<Start> = (1..40).map(|id| start(id, 100.0)).collect();
        let (plain, relaxed) = (run(wall(), 1.0, &starts), run(wall(), 1.6, &starts));
        assert!(relaxed.1 as f64 <= 0.7 * plain.1 as f64, "{} instead of {}", relaxed.1, plain.1);
        assert!(plain.0.iter().chain(&relaxed.0).all(|end| end.fate == Fate::Passed));
    }
}
