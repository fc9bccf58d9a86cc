//! The number types by themselves: intervals contain, masks are three-valued, loops stop.

mod common;

use common::Random;
use freikugel_field::scalar::Trilean;
use freikugel_field::{Dual, Interval, Scalar};
use proptest::prelude::*;

fn allows(outcome: Trilean, truth: bool) -> bool {
    if truth { outcome.can_hold } else { outcome.can_fail }
}

/// An interval and a number in it.
fn interval_with_member() -> impl Strategy<Value = (Interval, f64)> {
    (-1e3..1e3_f64, prop_oneof![Just(0.0), 0.0..1e-9_f64, 0.0..10.0_f64], 0.0..=1.0_f64)
        .prop_map(|(lo, width, share)| (Interval::new(lo, lo + width), (lo + width * share).clamp(lo, lo + width)))
}

proptest! {
    #[test]
    fn results_lie_in_the_interval((a, x) in interval_with_member(), (b, y) in interval_with_member()) {
        prop_assert!((a + b).contains(x + y));
        prop_assert!((a - b).contains(x - y));
        prop_assert!((a * b).contains(x * y));
        if y != 0.0 {
            prop_assert!((a / b).contains(x / y));
        }
        prop_assert!((-a).contains(-x));
        prop_assert!(Scalar::abs(a).contains(x.abs()));
        prop_assert!(a.square().contains(x * x));
        prop_assert!(Scalar::sqrt(Scalar::abs(a)).contains(x.abs().sqrt()));
        prop_assert!(Scalar::min(a, b).contains(x.min(y)));
        prop_assert!(Scalar::max(a, b).contains(x.max(y)));
        prop_assert!(Interval::length2(a, b).contains(f64::length2(x, y)));
        prop_assert!(Interval::length3(a, b, a).contains(f64::length3(x, y, x)));
        prop_assert!((a * 0.1).contains(x * 0.1) && (a + 0.1).contains(x + 0.1) && (a - 0.1).contains(x - 0.1));
        let less = a.lt(b);
        let smaller = if x < y { x } else { y };
        prop_assert!(allows(less, x < y) && Interval::select(less, a, b).contains(smaller));
        // The middle of an interval may lie on either side of a number in it.
        let (low, is_low) = (a.lt(Interval::point(a.middle())), x < a.middle());
        prop_assert!(allows(!less, x >= y));
        prop_assert!(allows(less & low, x < y && is_low));
        prop_assert!(allows(less | low, x < y || is_low));
    }

    #[test]
    fn the_sum_of_points_is_a_few_units_wide(x in -1e3..1e3_f64, y in -1e3..1e3_f64) {
        let sum = Interval::point(x) + Interval::point(y);
        prop_assert!(sum.width() <= 4.0 * f64::EPSILON * (x + y).abs().max(f64::MIN_POSITIVE));
    }

    #[test]
    fn duals_follow_the_rules(x in 0.1..3.0_f64, y in 0.1..3.0_f64) {
        let (a, b) = (Dual::input(x, 0), Dual::input(y, 1));
        let check = |dual: Dual<f64>, value: f64, dx: f64, dy: f64| {
            let close = |a: f64, b: f64| (a - b).abs() < 1e-12 * (1.0 + b.abs());
            prop_assert!(close(dual.value, value) && close(dual.gradient[0], dx) && close(dual.gradient[1], dy));
            Ok(())
        };
        check(a * b, x * y, y, x)?;
        check(a / b, x / y, 1.0 / y, -x / (y * y))?;
        check(Scalar::sqrt(a), x.sqrt(), 0.5 / x.sqrt(), 0.0)?;
        check(a.square() - b * 3.0, x * x - 3.0 * y, 2.0 * x, -3.0)?;
        check(Dual::length2(a, b), x.hypot(y), x / x.hypot(y), y / x.hypot(y))?;
        check(Scalar::min(a, b), x.min(y), f64::from(x < y), f64::from(x >= y))?;
    }
}

#[test]
fn lengths_and_roots_at_zero_have_finite_derivatives() {
    let zero = Dual::input(0.0, 0);
    for dual in [Scalar::sqrt(zero), Dual::length2(zero, zero), Dual::length3(zero, zero, zero), Scalar::abs(zero)] {
        assert!(dual.gradient.iter().all(|d| d.is_finite()), "{dual:?}");
    }
}

#[test]
fn iteration_stops_lane_by_lane_and_at_the_limit() {
    let doubled = |limit: u32, until: f64| f64::iterate(limit, [1.0], |[s]| ([s * 2.0], (s * 2.0).lt(until)))[0];
    assert_eq!(doubled(100, 50.0), 64.0);
    assert_eq!(doubled(3, 50.0), 8.0);
    assert_eq!(doubled(0, 50.0), 1.0);
    // An interval runs on while any of its numbers would, and covers where each stops.
    let [s] = Interval::iterate(100, [Interval::new(1.0, 3.0)], |[s]| ([s * 2.0], (s * 2.0).lt(s.lift(50.0))));
    assert!(s.contains(64.0) && s.contains(96.0));
}

#[test]
fn intervals_at_the_ends_of_the_line_stay_sound() {
    let entire = Interval::ENTIRE;
    for result in [entire + entire, entire - entire, entire * Interval::point(0.0), Interval::point(1.0) / entire] {
        assert!(result.contains(0.0), "{result:?}");
    }
    assert!(Scalar::sqrt(entire).contains(3.0));
    assert!((Interval::point(f64::MAX) * 2.0).contains(f64::MAX));
}

#[test]
fn zigzags_are_enclosed_narrowly() {
    let mut random = Random::new(17);
    for _ in 0..2000 {
        let (lo, width) = (random.range(-9.0, 9.0), random.range(0.0, 2.5));
        let x = Interval::new(lo, lo + width);
        let found = x.zigzag();
        let slope = Dual { value: x, gradient: [Interval::point(1.0)] }.zigzag().gradient[0];
        assert!(found.width() <= width.min(1.0) + 1e-12, "{x:?} became {found:?}");
        for share in 0..=20 {
            let at = lo + width * f64::from(share) / 20.0;
            let nearest_even = 2.0 * (at / 2.0).round();
            assert!(found.contains((at - nearest_even).abs()), "{at} of {x:?} is not in {found:?}");
            assert!(slope.contains((at - nearest_even).signum()), "the slope at {at} of {x:?} is not in {slope:?}");
        }
    }
}
