//! Marching by steps of one length, the oldest way to find a surface (Perlin and Hoffert, "Hypertexture", 1989).
//!
//! Where the sign changes between two steps, bisection closes in on the zero. Fields without a sign have none to change:
//! where three steps show a valley, its bottom is found by golden sections (Kiefer, "Sequential minimax search for a
//! maximum", 1953), and is a hit if it reaches down to 0. The method needs to know nothing about the field, and misses
//! what is thinner than a step.

use crate::march::{End, Fate, Pace, Start};
use crate::vector::add_scaled;
use freikugel_field::{Evaluator, Part, Points};

/// How often the interval is halved in which the sign changes: to a 65,536th of a step.
const HALVINGS: u32 = 16;

/// How often a valley is narrowed down: to a 50,000th of a step.
const NARROWINGS: u32 = 24;

/// The part of a valley's depth that a bottom at 0 may be missed by; the narrowing leaves less.
const BOTTOM: f32 = 1e-3;

/// What golden sections cut off from the longer part.
const GOLDEN: f32 = 0.381_966;

/// What holds for all rays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rules {
    pub(crate) pace: Pace,
    /// How far a step goes, in world units.
    pub(crate) step: f32,
    /// Whether the field is without a sign somewhere.
    pub(crate) has_sheets: bool,
    /// Whether to look for the least ratio of clearance to distance besides.
    pub(crate) is_soft: bool,
}

/// The rays on their way.
#[derive(Default)]
pub(crate) struct Fixed {
    rays: Vec<Walker>,
    point: [Vec<f32>; 3],
    value: Vec<f32>,
}

/// A ray.
#[derive(Clone, Copy)]
struct Walker {
    start: Start,
    t: f32,
    steps: u32,
    /// Where it was one step and two steps ago, and the values there, which are no numbers at the start.
    before: [[f32; 2]; 2],
    state: State,
    /// The least ratio of clearance to distance so far, times the sharpness.
    factor: f32,
}

#[derive(Clone, Copy)]
enum State {
    Walking,
    /// Positive at `near`, negative at `far`.
    Halving {
        near: f32,
        far: f32,
        left: u32,
    },
    /// Higher at both ends than in the middle.
    Narrowing {
        valley: Valley,
        left: u32,
    },
}

#[derive(Clone, Copy)]
struct Valley {
    low: f32,
    bottom: f32,
    high: f32,
    /// The value at the bottom, and the lower one of the values at the ends when it was found.
    value: f32,
    rim: f32,
    /// Where to go on if there is no zero, and the value there.
    resume: [f32; 2],
}

impl Fixed {
    /// Takes all rays to their first surface. Appends how they ended, in no particular order, and returns how many field
    /// values that took.
    pub(crate) fn run(
        &mut self,
        field: &mut Evaluator<'_>,
        part: &Part,
        rules: Rules,
        starts: &[Start],
        ends: &mut Vec<End>,
    ) -> u64 {
        let Self { rays, point, value } = self;
        rays.extend(starts.iter().map(|start| Walker {
            start: *start,
            t: start.span[0],
            steps: start.steps,
            before: [[start.span[0], f32::NAN]; 2],
            state: State::Walking,
            factor: 1.0,
        }));
        let mut evaluations = 0;
        while !rays.is_empty() {
            point.iter_mut().for_each(Vec::clear);
            for ray in &*rays {
                let place = add_scaled(ray.start.origin, ray.probe(), ray.start.direction);
                point.iter_mut().zip(place).for_each(|(numbers, number)| numbers.push(number));
            }
            value.resize(rays.len(), 0.0);
            let [x, y, z] = &*point;
            field.values_in(part, Points { x, y, z }, value);
            evaluations += rays.len() as u64;
            let mut values = value.iter();
            rays.retain_mut(|ray| {
                let Some((fate, t, value)) = ray.advance(*values.next().expect("a value for each ray"), &rules) else {
                    return true;
                };
                let factor = if fate == Fate::Hit { 0.0 } else { ray.factor };
                let (id, steps, place) = (ray.start.id, ray.steps, End::NOWHERE);
                ends.push(End { id, fate, t, value, steps, factor, place });
                false
            });
        }
        evaluations
    }
}

impl Walker {
    /// Where the ray wants to know the field.
    fn probe(&self) -> f32 {
        match self.state {
            State::Walking => self.t,
            State::Halving { near, far, .. } => 0.5 * (near + far),
            State::Narrowing { valley, .. } => valley.probe(),
        }
    }

    /// Goes on, knowing the field at the probe; or says how the ray ended, where, and with what value.
    fn advance(&mut self, value: f32, rules: &Rules) -> Option<(Fate, f32, f32)> {
        match &mut self.state {
            State::Walking => self.walk(value, rules),
            State::Halving { near, far, left } => {
                let middle = 0.5 * (*near + *far);
                *(if value < 0.0 { far } else { &mut *near }) = middle;
                *left -= 1;
                (*left == 0).then_some((Fate::Hit, *near, 0.0))
            }
            State::Narrowing { valley, left } => {
                valley.narrow(value);
                *left -= 1;
                if *left > 0 {
                    return None;
                }
                let Valley { bottom, value, rim, resume: [t, here], .. } = *valley;
                let [base, growth] = self.start.tolerance;
                if value < base + growth * bottom || value < BOTTOM * rim {
                    return Some((Fate::Hit, bottom, 0.0));
                }
                (self.state, self.t) = (State::Walking, t);
                self.step(here, rules)
            }
        }
    }

    fn walk(&mut self, value: f32, rules: &Rules) -> Option<(Fate, f32, f32)> {
        let [base, growth] = self.start.tolerance;
        let [[near, last], [low, earlier]] = self.before;
        if rules.is_soft && value > 0.0 {
            self.factor = self.factor.min(self.start.sharpness * value * rules.pace.scale / self.t);
        }
        // On its way, a ray that is merely near to a surface goes on to where the sign changes: values that are small because the
        // field is flat are no hits. Without a sign there is nothing else to go by.
        let is_near = value < base + growth * self.t && (last.is_nan() || rules.has_sheets);
        if value < 0.0 || is_near {
            // From a positive value the zero lies behind; otherwise the ray begins on the surface or in the solid.
            if value < 0.0 && last > 0.0 {
                self.state = State::Halving { near, far: self.t, left: HALVINGS };
                return None;
            }
            return Some((Fate::Hit, self.t, value));
        }
        if rules.has_sheets && last <= earlier && last <= value {
            let (high, rim) = (self.t, value.min(earlier));
            let valley = Valley { low, bottom: near, high, value: last, rim, resume: [self.t, value] };
            self.state = State::Narrowing { valley, left: NARROWINGS };
            return None;
        }
        self.step(value, rules)
    }

    /// Takes a step from where the field has a value.
    fn step(&mut self, value: f32, rules: &Rules) -> Option<(Fate, f32, f32)> {
        let end = self.start.span[1];
        if self.t >= end {
            return Some((Fate::Passed, self.t, value));
        }
        if self.steps >= rules.pace.max_steps {
            return Some((Fate::Exhausted, self.t, value));
        }
        self.steps += 1;
        self.before = [[self.t, value], self.before[0]];
        self.t = (self.t + rules.step).min(end);
        None
    }
}

impl Valley {
    /// In the longer one of the two parts.
    fn probe(&self) -> f32 {
        let (left, right) = (self.bottom - self.low, self.high - self.bottom);
        if right > left { self.bottom + GOLDEN * right } else { self.bottom - GOLDEN * left }
    }

    fn narrow(&mut self, value: f32) {
        let probe = self.probe();
        let is_right = probe > self.bottom;
        if value < self.value {
            *(if is_right { &mut self.low } else { &mut self.high }) = self.bottom;
            (self.bottom, self.value) = (probe, value);
        } else {
            *(if is_right { &mut self.high } else { &mut self.low }) = probe;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use freikugel_field::{Field, Structure, shapes::*};

    /// How a ray along x ends that begins at 0 and steps 0.3 wide.
    fn run(field: impl Into<Field>, end: f32, has_sheets: bool) -> End {
        let structure = Structure::compile(&[field.into()]).expect("a sound field");
        let program = structure.program(glam::DVec3::ZERO);
        let pace = Pace { scale: 1.0, step_factor: 1.0, max_steps: 1000 };
        let start = Start {
            id: 0,
            origin: [0.0; 3],
            direction: [1.0, 0.0, 0.0],
            span: [0.0, end],
            tolerance: [1e-5, 0.0],
            steps: 0,
            sharpness: 1.0,
        };
        let rules = Rules { pace, step: 0.3, has_sheets, is_soft: false };
        let mut ends = Vec::new();
        Fixed::default().run(&mut Evaluator::new(&program), program.whole(), rules, &[start], &mut ends);
        assert_eq!(ends.len(), 1);
        ends[0]
    }

    #[test]
    fn a_change_of_sign_is_closed_in_on() {
        for distance in [0.1, 1.0, 1.23, 7.77, 9.95] {
            let end = run(sphere(1.0).at([distance + 1.0, 0.0, 0.0]), 10.0, false);
            assert_eq!(end.fate, Fate::Hit);
            assert!((f64::from(end.t) - distance).abs() < 2e-5, "{} for {distance}", end.t);
            assert_eq!(end.steps, (distance / 0.3).ceil() as u32, "{distance}");
        }
    }

    #[test]
    fn the_bottom_of_a_valley_is_a_hit_if_it_is_a_zero() {
        for distance in [1.6, 2.23, 7.77] {
            let wall = || sheet([1.0, 0.5, 0.0]).at([distance, 0.0, 0.0]);
            let end = run(wall(), 10.0, true);
            assert_eq!(end.fate, Fate::Hit);
            assert!((f64::from(end.t) - distance).abs() < 1e-4, "{} for {distance}", end.t);
            // A ball beside the ray makes a valley, too, whose bottom is not 0.
            let end = run(wall() | sphere(0.1).at([0.4, 0.15, 0.0]), 10.0, true);
            assert!((f64::from(end.t) - distance).abs() < 1e-4, "{} for {distance}", end.t);
        }
    }

    #[test]
    fn what_is_thinner_than_a_step_or_lies_behind_the_end_is_missed() {
        assert_eq!(run(cuboid([0.1, 1.0, 1.0]).at([1.35, 0.0, 0.0]), 10.0, false).fate, Fate::Passed);
        assert_eq!(run(sphere(1.0).at([11.2, 0.0, 0.0]), 10.0, false).fate, Fate::Passed);
        assert_eq!(run(sphere(1.0).at([10.9, 0.0, 0.0]), 10.0, false).fate, Fate::Hit);
    }
}
