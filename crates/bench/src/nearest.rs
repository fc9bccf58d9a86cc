//! The nearest of a million points: a shape of points, and a kd-tree.

use crate::evaluation::program;
use crate::measure::{Clock, Contender, Row, Unit};
use crate::scattered::Random;
use freikugel::field::{Evaluator, Points, Program, shapes, simd};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use std::hint::black_box;
use std::sync::OnceLock;

/// How many points there are.
const COUNT: usize = if cfg!(test) { 20_000 } else { 1_000_000 };

/// How many queries are asked at once.
const QUERIES: usize = 1 << 16;

/// Steps of a query's coordinates in the order of places.
const STEPS: f32 = 1024.0;

/// All rows whose names `is_wanted`.
pub fn rows(is_wanted: &dyn Fn(&str) -> bool) -> Vec<Row<'static>> {
    let names = ["in any order", "neighbours one after another"];
    let rows = names.into_iter().zip([false, true]).map(|(order, is_sorted)| {
        let name = format!("nearest of a million points, queries {order}");
        is_wanted(&name).then(|| Row { name, unit: Unit::Points(QUERIES), contenders: contenders(is_sorted) })
    });
    rows.flatten().collect()
}

/// Random points of the cube from -1 to 1.
fn scattered(random: &mut Random, count: usize) -> Vec<[f32; 3]> {
    (0..count).map(|_| [(); 3].map(|()| (2.0 * random.next() - 1.0) as f32)).collect()
}

/// What is searched: our program and the peer's tree, of the same points, and queries.
struct Data {
    program: Program,
    tree: ImmutableKdTree<f32, 3>,
    queries: Vec<[f32; 3]>,
}

fn data() -> &'static Data {
    static DATA: OnceLock<Data> = OnceLock::new();
    DATA.get_or_init(|| {
        let mut random = Random::default();
        let points = scattered(&mut random, COUNT);
        let tree = ImmutableKdTree::new_from_slice(&points).expect("points that can be told apart");
        // The radius is next to nothing, so that values are distances.
        let program = program(shapes::point_set(1e-6, points.iter().map(|point| point.map(f64::from))).into());
        Data { program, tree, queries: scattered(&mut random, QUERIES) }
    })
}

/// The place of a point along Morton's curve, by which neighbours mostly follow each other.
fn place(point: &[f32; 3]) -> u32 {
    let [x, y, z] = point.map(|coordinate| ((coordinate + 1.0) / 2.0 * (STEPS - 1.0)) as u32);
    (0..STEPS.log2() as u32).map(|bit| ((x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2) << (3 * bit)).sum()
}

/// All x, all y, and all z.
fn columns(points: &[[f32; 3]]) -> [Vec<f32>; 3] {
    [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).collect())
}

fn contenders(is_sorted: bool) -> Vec<Contender<'static>> {
    let Data { program, tree, queries } = data();
    let mut queries = queries.clone();
    if is_sorted {
        queries.sort_by_key(place);
    }
    let [x, y, z] = columns(&queries);
    let ours = simd::available().into_iter().rev().map(|level| {
        let mut evaluator = Evaluator::with_level(program, level);
        let (x, y, z, mut values) = (x.clone(), y.clone(), z.clone(), vec![0.0; QUERIES]);
        Contender::new(format!("Freikugel {}", simd::name(level)), Clock::Thread, move || {
            evaluator.values(Points { x: &x, y: &y, z: &z }, &mut values);
            black_box(&values);
        })
    });
    let mut contenders: Vec<_> = ours.collect();
    contenders.push(Contender::new("kiddo", Clock::Thread, move || {
        for query in &queries {
            black_box(tree.query(query).nearest_one::<SquaredEuclidean<f32>>().execute());
        }
    }));
    contenders
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_find_the_same_distances() {
        let Data { program, tree, queries } = data();
        let mut values = vec![0.0; QUERIES];
        let [x, y, z] = columns(queries);
        Evaluator::new(program).values(Points { x: &x, y: &y, z: &z }, &mut values);
        for (query, value) in queries.iter().zip(values) {
            let theirs = tree.query(query).nearest_one::<SquaredEuclidean<f32>>().execute().distance.sqrt();
            assert!((theirs - value).abs() < 1e-5, "{theirs} and {value} at {query:?}");
        }
    }

    #[test]
    fn places_follow_the_curve() {
        let corners = [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, 1.0, 1.0]];
        let places = corners.map(|corner| place(&corner));
        assert!(places.is_sorted());
        assert_eq!([places[0], places[4]], [0, (1 << 30) - 1]);
    }
}
