//! Sampled fields beside those they were sampled from.

use freikugel_grid::{Block, Bricks, GridError, Lattice, Points, SAMPLES, Source};
use glam::Vec3;

/// A field by its formula; labels tell the sides of the plane x = 0.
struct Of<F>(F);

impl<F: Fn(Vec3) -> f32> Source for Of<F> {
    fn values(&mut self, block: &Block, points: &Points, values: &mut [f32]) {
        let slack = 1e-5 * (1.0 + block.max.abs().max_element());
        for (value, p) in values.iter_mut().zip(points.iter()) {
            assert!(p.cmpge(block.min - slack).all() && p.cmple(block.max + slack).all(), "{p} in {block:?}");
            *value = (self.0)(p);
        }
    }

    fn labels(&mut self, _: &Block, points: &Points, labels: &mut [u32]) {
        labels.iter_mut().zip(points.iter()).for_each(|(label, p)| *label = u32::from(p.x >= 0.0));
    }
}

const RADIUS: f32 = 0.9;

fn ball(p: Vec3) -> f32 {
    p.length() - RADIUS
}

/// A box with a ball cut out of it: edges, corners, and distances that are lower bounds in places.
fn cut_box(p: Vec3) -> f32 {
    let q = p.abs() - Vec3::new(0.9, 0.6, 0.4);
    let outside = q.max(Vec3::ZERO).length() + q.max_element().min(0.0);
    outside.max(0.45 - p.distance(Vec3::new(0.5, 0.2, 0.4)))
}

fn sampled(field: impl Fn(Vec3) -> f32, cells: u32) -> Bricks {
    let lattice = Lattice::around(Vec3::splat(-1.0), Vec3::splat(1.0), cells).expect("a lattice");
    Bricks::sample(lattice, &mut Of(field)).expect("samples")
}

/// Points spread evenly over a cube (an additive recurrence: multiples of three irrational steps, modulo 1).
fn points(half: f32) -> impl Iterator<Item = Vec3> {
    let steps = [0.819_172_5_f64, 0.671_043_6, 0.549_700_5];
    (1..20_000).map(move |i| {
        let [x, y, z] = steps.map(|step| ((f64::from(i) * step).fract() * 2.0 - 1.0) as f32 * half);
        Vec3::new(x, y, z)
    })
}

/// Rounding errors of values around 1.
const ROUNDING: f32 = 1e-5;

#[test]
fn values_are_off_by_no_more_than_they_may() {
    for field in [ball, cut_box] {
        for cells in [16, 50, 97] {
            let bricks = sampled(field, cells);
            let half_diagonal = 3.0_f32.sqrt() / 2.0;
            for p in points(1.0) {
                let edge = if bricks.label(p).is_some() { bricks.lattice().voxel() } else { bricks.lattice().brick() };
                let error = (bricks.value(p) - field(p)).abs();
                // The middles at the border lie to one side: there the value of the own brick bounds it, twice as loosely.
                let most = if bricks.label(p).is_some() { 1.0 } else { 2.0 } * half_diagonal * edge;
                assert!(error <= most + ROUNDING, "{cells} cells at {p}: {error}");
            }
        }
    }
}

#[test]
fn smooth_surfaces_are_of_second_order() {
    for cells in [18, 34, 66, 130] {
        let bricks = sampled(ball, cells);
        let voxel = bricks.lattice().voxel();
        // Where fine samples are for certain.
        let near = points(1.0).filter(|p| ball(*p).abs() < 2.0 * voxel - ROUNDING);
        let largest = near.map(|p| (bricks.value(p) - ball(p)).abs()).fold(0.0, f32::max);
        // A distance from a ball bends by 1 over the distance from its middle, along two axes.
        let bound = 0.25 * voxel * voxel / (RADIUS - 4.0 * voxel) + ROUNDING;
        assert!(largest <= bound, "{cells} cells: {largest} > {bound}");
    }
}

#[test]
fn no_brick_with_a_surface_is_missing() {
    for field in [ball, cut_box] {
        for cells in [16, 50, 97] {
            let bricks = sampled(field, cells);
            let voxel = bricks.lattice().voxel();
            let near = points(1.0).filter(|p| field(*p).abs() < 2.0 * voxel - ROUNDING);
            near.for_each(|p| assert!(bricks.label(p).is_some(), "{cells} cells at {p}"));
        }
    }
}

#[test]
fn free_ways_without_samples_meet_nothing() {
    for field in [ball, cut_box] {
        let bricks = sampled(field, 64);
        // Also from outside of the box.
        for p in points(3.0).filter(|p| bricks.label(*p).is_none() || p.abs().max_element() > 1.2) {
            let (free, value) = (bricks.free(p), field(p));
            // Seen from outside of the box, values interpolated on its faces count, a tenth or more away from all surfaces, where
            // fields bend by no more than 10.
            let most = if bricks.label(p).is_none() { 0.0 } else { 0.25 * 10.0 * bricks.lattice().voxel().powi(2) };
            assert!(free.abs() <= value.abs() + most + ROUNDING, "{p}: {free}, {value}");
            assert_eq!(free < 0.0, value < 0.0, "{p}");
        }
    }
}

#[test]
fn a_dense_grid_interpolates_the_same() {
    let bricks = sampled(cut_box, 50);
    let lattice = *bricks.lattice();
    for p in points(1.0).filter(|p| bricks.label(*p).is_some()) {
        // Eight weighted corners of the cell, from the field itself.
        let cells = (p - lattice.min()) / lattice.voxel();
        let share = cells - cells.floor();
        let mut sum = 0.0;
        for corner in 0..8 {
            let step = Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2) as f32);
            let weight = (step * share + (1.0 - step) * (1.0 - share)).element_product();
            sum += weight * cut_box(lattice.min() + (cells.floor() + step) * lattice.voxel());
        }
        assert!((bricks.value(p) - sum).abs() < ROUNDING, "{p}");
    }
}

#[test]
fn labels_are_those_of_the_nearest_samples() {
    let bricks = sampled(ball, 64);
    let half = 0.5 * bricks.lattice().voxel() + ROUNDING;
    for p in points(1.0).filter(|p| p.x.abs() > half) {
        assert!(bricks.label(p).is_none_or(|label| label == u32::from(p.x >= 0.0)), "{p}");
    }
}

#[test]
fn memory_grows_with_the_surface() {
    let [coarse, fine] = [64, 128].map(|cells| sampled(ball, cells));
    assert_eq!(coarse.bytes(), 8 * (coarse.kept() * SAMPLES.pow(3) as usize + coarse.lattice().count()));
    // Twice the cells: four times the surface, and a thinner margin.
    assert!(fine.bytes() < 5 * coarse.bytes(), "{} and {}", coarse.bytes(), fine.bytes());
    assert!(fine.kept() < fine.lattice().count() / 2);
}

#[test]
fn faults_are_told() {
    let (min, max) = (Vec3::splat(-1.0), Vec3::ONE);
    assert_eq!(Lattice::around(min, max, 15), Err(GridError::Cells(15)));
    assert_eq!(Lattice::around(min, max, 1025), Err(GridError::Cells(1025)));
    for wrong in [min, Vec3::splat(f32::INFINITY), Vec3::splat(-2.0), Vec3::splat(f32::NAN)] {
        assert!(matches!(Lattice::around(min, wrong, 50), Err(GridError::Box { .. })), "{wrong}");
    }
    let lattice = Lattice::around(min, max, 16).expect("a lattice");
    let gap = |p: Vec3| if p.x > 0.5 { f32::NAN } else { p.x };
    let Err(GridError::Value { at }) = Bricks::sample(lattice, &mut Of(gap)) else { panic!("no error") };
    assert!(at.x > 0.5, "{at}");
    let flat = Lattice::around(min, Vec3::new(1.0, 1.0, -1.0), 50).expect("a sheet has a lattice");
    assert_eq!(flat.bricks().to_array(), [7, 7, 1]);
}
