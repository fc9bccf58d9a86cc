//! Point queries of unions through a hierarchy give what the whole union gives.

mod common;

use common::{Random, tree};
use freikugel_field::shapes::*;
use freikugel_field::{Field, Nearest, Structure};
use glam::DVec3;

/// The value of the union by evaluating all of it.
fn whole(fields: &[Field], points: &[DVec3]) -> Vec<f64> {
    let program = Structure::compile(fields).expect("sound").program(DVec3::ZERO);
    points.iter().map(|&p| program.value(p)).collect()
}

/// Points near, inside and far away.
fn points(random: &mut Random, count: usize) -> Vec<DVec3> {
    (0..count).map(|i| random.point([0.5, 2.0, 5.0, 40.0][i % 4])).collect()
}

#[test]
fn a_query_gives_the_value_of_the_union_bit_for_bit() {
    for seed in 0..40 {
        let mut random = Random::new(seed);
        // Bounds, unbounded shapes and blends among exact distances.
        let fields: Vec<Field> =
            (0..1 + random.below(30)).map(|_| tree(2, &mut random).at(random.point(4.0).to_array())).collect();
        let points = points(&mut random, 60);
        let expected = whole(&fields, &points);
        let nearest = Nearest::new(&fields).expect("sound");
        let mut values = vec![0.0; points.len()];
        nearest.values(&points, &mut values);
        assert_eq!(values, expected, "seed {seed}, one after another");
        for (&p, expected) in points.iter().zip(expected) {
            let hit = nearest.find(p).expect("there are shapes");
            assert_eq!(hit.value, expected, "seed {seed} at {p}");
            assert!(hit.evaluations <= nearest.count(), "seed {seed}: each shape at most once");
        }
    }
}

#[test]
fn ties_and_no_shapes_are_no_trouble() {
    let twins: Vec<Field> = (0..9).map(|_| sphere(1.0).into()).collect();
    let nearest = Nearest::new(&twins).expect("sound");
    assert_eq!(nearest.value(DVec3::X * 3.0), 2.0);
    assert_eq!(nearest.value(DVec3::ZERO), -1.0);
    let nothing = Nearest::new(&[]).expect("no fault");
    assert_eq!((nothing.value(DVec3::ZERO), nothing.find(DVec3::ZERO)), (f64::INFINITY, None));
    assert!(Nearest::new(&[sphere(-1.0).into()]).is_err());
}

fn balls(count: usize, random: &mut Random) -> Vec<Field> {
    let reach = (count as f64).cbrt();
    let mut one = |_| {
        let at = random.point(reach).to_array();
        match random.below(3) {
            0 => sphere(0.3).at(at),
            1 => cuboid([0.4, 0.5, 0.6]).rotate([1.0, 2.0, 3.0], 50.0).at(at),
            _ => torus(0.3, 0.1).at(at),
        }
    };
    (0..count).map(&mut one).collect()
}

#[test]
fn the_number_of_evaluations_grows_far_slower_than_the_number_of_shapes() {
    let mut random = Random::new(7);
    let mut mean = |count: usize| {
        let fields = balls(count, &mut random);
        // As one union, which is taken apart.
        let nearest = Nearest::new(&[Field::new(&UNION, [], fields)]).expect("sound");
        assert_eq!(nearest.count(), count);
        let points = points(&mut random, 200);
        let evaluations: usize = points.iter().map(|&p| nearest.find(p).expect("there are shapes").evaluations).sum();
        evaluations as f64 / points.len() as f64
    };
    let (few, many) = (mean(50), mean(5000));
    assert!(many < 2.5 * few && many < 20.0, "{few} of 50, {many} of 5000");
}

#[test]
fn copies_are_taken_apart() {
    let mut random = Random::new(40);
    let places: Vec<[f64; 3]> = (0..500).map(|_| random.point(1.0).to_array()).collect();
    let cloud = [sphere(0.02).scatter(places)];
    let nearest = Nearest::new(&cloud).expect("sound");
    assert_eq!(nearest.count(), 500);
    let points = points(&mut random, 100);
    let mut values = vec![0.0; points.len()];
    nearest.values(&points, &mut values);
    assert_eq!(values, whole(&cloud, &points));
    let evaluations: usize = points.iter().filter_map(|&p| nearest.find(p)).map(|hit| hit.evaluations).sum();
    assert!(evaluations < 10 * points.len(), "{evaluations} for {} points", points.len());
}

#[test]
fn bounds_are_pruned_too() {
    let mut random = Random::new(8);
    let fields: Vec<Field> = (0..1000)
        .map(|_| (cuboid([0.5; 3]) - sphere(0.3)).stretch([1.0, 0.6, 1.4]).at(random.point(10.0).to_array()))
        .collect();
    let nearest = Nearest::new(&fields).expect("sound");
    let points: Vec<DVec3> = (0..100).map(|_| random.point(10.0)).collect();
    let evaluations: usize = points.iter().map(|&p| nearest.find(p).expect("there").evaluations).sum();
    assert!(evaluations < 100 * points.len(), "{} of 1000 on average", evaluations / points.len());
}
