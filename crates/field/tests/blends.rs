//! What all families of blends promise: their size, symmetry, shares and boxes.

mod common;

use common::{Random, is_blend};
use freikugel_field::kernel::{BATCH, Block, CombineJob};
use freikugel_field::shape::{CombineTable, Settled};
use freikugel_field::{
    Constants, Extent, Field, Interval, Kind, ParamKind, Program, Shape, Structure, analyse, extent, shapes, simd,
};
use freikugel_field::{Origin, Value};
use glam::DVec3;

/// All blends with the families' tables, and the common ones.
fn blends() -> impl Iterator<Item = (&'static Shape, &'static CombineTable)> {
    let common = ["smooth_union", "smooth_intersection", "smooth_difference"];
    let blends =
        shapes::ALL.iter().filter(move |shape| is_blend(shape.about.name) || common.contains(&shape.about.name));
    blends.map(|shape| match &shape.kind {
        Kind::Combine(table) => (*shape, table),
        _ => panic!("{} is no combination", shape.about.name),
    })
}

/// Several choices of a blend's own parameter.
fn own(shape: &Shape) -> &'static [Option<f64>] {
    match shape.about.params[1].name {
        // Of the common ones, the place among two.
        "order" if matches!(shape.about.params[1].kind, ParamKind::Choice(_)) => &[Some(0.0), Some(1.0)],
        "order" => &[Some(1.1), Some(2.0), Some(3.7)],
        "steps" => &[Some(1.0), Some(2.0), Some(5.0)],
        "columns" => &[Some(2.0), Some(3.0), Some(6.0)],
        _ => &[None],
    }
}

/// A blend's arguments: its size, its own parameter, how far materials mix.
fn args(shape: &Shape, k: f64, own: Option<f64>, mix: f64) -> Vec<f64> {
    let mut all = vec![k];
    all.extend(own);
    all.push(mix);
    if shape.about.params.last().is_some_and(|p| p.name == "keep_material") {
        all.push(0.0);
    }
    all
}

/// What the blend makes of two numbers, in double precision.
fn value(table: &CombineTable, args: &[f64], a: f64, b: f64) -> f64 {
    let constants = (table.prepare)(args);
    let with = Constants::new(a, &constants[..], constants.len());
    (table.kernels.real)(a, b, &with)
}

/// The share of the second operand and the value, in single precision on each instruction set; all must agree.
fn single(table: &CombineTable, args: &[f64], pairs: &[[f64; 2]]) -> Vec<[f32; 2]> {
    let constants: Vec<f32> = (table.prepare)(args).into_iter().map(|c| c as f32).collect();
    let mut all = Vec::new();
    for chunk in pairs.chunks(BATCH) {
        let (mut a, mut b) = ([Block::default()], [Block::default()]);
        for (i, pair) in chunk.iter().enumerate() {
            (a[0].0[i], b[0].0[i]) = (pair[0] as f32, pair[1] as f32);
        }
        let mut first: Option<Vec<[f32; 2]>> = None;
        for level in simd::available() {
            let (mut values, mut shares) = ([Block::default()], [Block::default()]);
            let count = BATCH;
            (table.kernels.values)(
                level,
                &mut CombineJob { a: &a, b: &b, constants: &constants, out: &mut values, count },
            );
            (table.kernels.shares)(
                level,
                &mut CombineJob { a: &a, b: &b, constants: &constants, out: &mut shares, count },
            );
            let these: Vec<[f32; 2]> = (0..chunk.len()).map(|i| [values[0].0[i], shares[0].0[i]]).collect();
            assert_eq!(first.get_or_insert_with(|| these.clone()), &these, "{level:?}");
        }
        all.extend(first.expect("one instruction set"));
    }
    all
}

/// The operator without any blend.
fn sharp(name: &str, a: f64, b: f64) -> f64 {
    match name.split_once('_').expect("family and operator").1 {
        "union" => a.min(b),
        "intersection" => a.max(b),
        "difference" => a.max(-b),
        other => panic!("{other}"),
    }
}

/// The gap between the operands as the operator sees them.
fn gap(name: &str, a: f64, b: f64) -> f64 {
    if name.ends_with("difference") { (a + b).abs() } else { (a - b).abs() }
}

#[test]
fn farther_than_k_from_the_seam_a_blend_is_the_sharp_operator() {
    // The exponential has no end; this much of k is left of it, far less than a pixel.
    const UNSEEN: f64 = 1e-4;
    let mut random = Random::new(1);
    for (shape, table) in blends() {
        let name = shape.about.name;
        for &own in own(shape) {
            for k in [0.0, 1e-3, 0.4, 30.0] {
                let args = args(shape, k, own, 1.0);
                let mut deepest: f64 = 0.0;
                for _ in 0..2000 {
                    let (a, b) = (random.range(-2.0, 2.0) * k.max(1e-3), random.range(-2.0, 2.0) * k.max(1e-3));
                    let (blend, sharp) = (value(table, &args, a, b), sharp(name, a, b));
                    let added = if name.ends_with("union") { sharp - blend } else { blend - sharp };
                    assert!(added >= -1e-12 * k, "{name} {own:?}: a blend of {a} and {b} fills, never cuts: {added}");
                    if gap(name, a, b) > k {
                        let unseen = if name.starts_with("exponential") { UNSEEN * k } else { 0.0 };
                        assert!(added <= unseen, "{name} {own:?} {k}: {added} from {a} and {b}");
                    }
                    deepest = deepest.max(added);
                }
                // Not the sharp operator everywhere, and not wider than said.
                assert!(deepest >= 0.04 * k && deepest <= 0.5 * k, "{name} {own:?} {k}: {deepest}");
            }
        }
    }
}

#[test]
fn shares_are_the_derivatives_and_keep_slopes() {
    const STEP: f64 = 1e-6;
    let mut random = Random::new(2);
    for (shape, table) in blends() {
        let name = shape.about.name;
        for &own in own(shape) {
            let args = args(shape, 0.4, own, 1.0);
            let pairs: Vec<[f64; 2]> =
                (0..1000).map(|_| [0, 1].map(|_| f64::from(random.range(-0.5, 0.5) as f32))).collect();
            let mut off = 0;
            for (&[a, b], [_, share]) in pairs.iter().zip(single(table, &args, &pairs)) {
                let at = |a, b| value(table, &args, a, b);
                let by_a = (at(a + STEP, b) - at(a - STEP, b)) / (2.0 * STEP);
                let by_b = (at(a, b + STEP) - at(a, b - STEP)) / (2.0 * STEP);
                assert!(by_a.abs() + by_b.abs() <= 1.0 + 1e-6, "{name} {own:?}: {by_a} and {by_b} at {a}, {b}");
                assert!((0.0..=1.0).contains(&share), "{name} {own:?}: {share}");
                let near =
                    (by_b.abs() - f64::from(share)).abs() < 1e-3 && (by_a.abs() + f64::from(share) - 1.0).abs() < 1e-3;
                off += usize::from(!near);
            }
            // Creases of chamfers and stairs, and the end of a polynomial near order 1, where single precision stands on the
            // other side.
            assert!(off <= 5, "{name} {own:?}: {off} of 1000 shares are no derivatives");
        }
    }
}

#[test]
fn operands_may_change_places() {
    let mut random = Random::new(3);
    for (shape, table) in blends() {
        let name = shape.about.name;
        if name.ends_with("difference") {
            continue;
        }
        for &own in own(shape) {
            let args = args(shape, 0.4, own, 1.0);
            for _ in 0..1000 {
                let [a, b, c] = [0, 1, 2].map(|_| random.range(-0.5, 0.5));
                let of = |a, b| value(table, &args, a, b);
                assert!((of(a, b) - of(b, a)).abs() < 1e-15, "{name} {own:?} of {a} and {b}");
                if name.starts_with("exponential") {
                    let (left, right) = (of(of(a, b), c), of(a, of(b, c)));
                    assert!((left - right).abs() < 1e-14, "{name} of {a}, {b} and {c}: {left} and {right}");
                }
            }
        }
    }
}

#[test]
fn large_distances_do_not_overflow() {
    for (shape, table) in blends() {
        let name = shape.about.name;
        for &own in own(shape) {
            for k in [0.0, 1e-9, 0.3] {
                let far = [-1e6, -3.0, 0.0, 3.0, 1e6];
                let pairs: Vec<[f64; 2]> = far.iter().flat_map(|&a| far.map(|b| [a, b])).collect();
                for (&[a, b], [blend, share]) in pairs.iter().zip(single(table, &args(shape, k, own, 1.0), &pairs)) {
                    let off = (f64::from(blend) - sharp(name, a, b)).abs();
                    let rounding = 1e-6 * (1.0 + sharp(name, a, b).abs());
                    assert!(off <= 0.5 * k + rounding, "{name} {own:?} {k}: {blend} from {a} and {b}");
                    assert!((0.0..=1.0).contains(&share), "{name} {own:?} {k}: {share} from {a} and {b}");
                }
            }
        }
    }
}

#[test]
fn what_is_settled_is_so_to_the_last_bit() {
    let mut random = Random::new(4);
    for (shape, table) in blends() {
        let name = shape.about.name;
        for &own in own(shape) {
            for mix in [0.5, 1.0, 3.0] {
                let args = args(shape, 0.3, own, mix);
                let constants = (table.prepare)(&args);
                let pairs: Vec<[f64; 2]> =
                    (0..2000).map(|_| [0, 1].map(|_| f64::from(random.range(-3.0, 3.0) as f32))).collect();
                let mut settled = 0;
                for (&[a, b], [blend, share]) in pairs.iter().zip(single(table, &args, &pairs)) {
                    let expected = match (table.settle)(Interval::point(a), Interval::point(b), &constants) {
                        Settled::Open => continue,
                        Settled::First => (a, 0.0),
                        Settled::Second => (b, 1.0),
                        Settled::NotSecond => (-b, 1.0),
                    };
                    settled += 1;
                    assert_eq!(
                        (f64::from(blend), share),
                        (expected.0, expected.1 as f32),
                        "{name} {own:?} of {a}, {b}"
                    );
                    assert_eq!(value(table, &args, a, b), expected.0, "{name} {own:?} of {a} and {b}");
                }
                assert!(settled > 100, "{name} {own:?}: {settled} of 2000 are settled");
            }
        }
    }
}

#[test]
fn materials_may_mix_over_another_length() {
    for (shape, table) in blends() {
        let name = shape.about.name;
        for &own in own(shape) {
            let pairs: Vec<[f64; 2]> = (-50..=50).map(|i| [0.0, 0.01 * f64::from(i)]).collect();
            let (wide, own_size) = (
                single(table, &args(shape, 0.1, own, 4.0), &pairs),
                single(table, &args(shape, 0.4, own, 1.0), &pairs),
            );
            let values = single(table, &args(shape, 0.1, own, 1.0), &pairs);
            for i in 0..pairs.len() {
                assert_eq!(wide[i][0], values[i][0], "{name} {own:?}: mixing changes no value");
                assert!(
                    (wide[i][1] - own_size[i][1]).abs() < 1e-6,
                    "{name} {own:?}: {} for {}",
                    wide[i][1],
                    own_size[i][1]
                );
            }
        }
    }
}

#[test]
fn the_bulge_of_many_stays_in_the_box() {
    for (shape, _) in blends().filter(|(shape, _)| shape.about.name.ends_with("union")) {
        let name = shape.about.name;
        for &own in own(shape) {
            for count in [1, 2, 3, 50] {
                let numbers: Vec<Value> = args(shape, 0.4, own, 1.0).into_iter().map(Into::into).collect();
                let spheres: Vec<Field> = (0..count).map(|_| Field::from(shapes::sphere(1.0))).collect();
                let field = Field::with_origin(shape, numbers, spheres, None, Origin::Document(0));
                let Extent::Finite(aabb) = extent(&field) else { panic!("{name} is finite") };
                let program: Program = Structure::compile(&[field]).expect("sound").program(DVec3::ZERO);
                // Equal operands bulge most.
                assert!(program.value(DVec3::X * (aabb.max.x + 1e-9)) >= 0.0, "{name} {own:?} of {count}: {aabb:?}");
                assert!(count > 2 || program.value(DVec3::X * (aabb.max.x - 1e-9)) <= 0.0, "{name} {own:?}: {aabb:?}");
            }
        }
    }
}

#[test]
fn an_order_of_1_and_sheets_are_refused() {
    let faults = |field: &Field| analyse(field).1.iter().map(|d| d.message.clone()).collect::<Vec<_>>().join("; ");
    let (a, sheet) = (|| Field::from(shapes::sphere(1.0)), || Field::from(shapes::sheet([0.0, 0.0, 1.0])));
    let flat = shapes::polynomial_union(0.3, [a(), a()]).with("order", &[1.0.into()]);
    assert!(faults(&flat).contains("above 1"), "{}", faults(&flat));
    for (shape, _) in blends() {
        let name = shape.about.name;
        let numbers: Vec<Value> = args(shape, 0.4, own(shape)[0], 1.0).into_iter().map(Into::into).collect();
        for operands in [[a(), sheet()], [sheet(), a()]] {
            let field = Field::with_origin(shape, numbers.clone(), operands.to_vec(), None, Origin::Document(0));
            assert!(faults(&field).contains("sheet"), "{name}: {}", faults(&field));
        }
    }
}

/// Independent ways to the surfaces over two right-angled faces, a along one axis and b along the other.
#[test]
fn profiles_are_what_their_names_say() {
    let k = 0.5;
    let table = |name: &str| {
        let (shape, table) = blends().find(|(shape, _)| shape.about.name == name).expect("a blend");
        (shape, table)
    };
    let zero = |name: &str, own: Option<f64>, b: f64| -> f64 {
        let (shape, table) = table(name);
        let args = args(shape, k, own, 1.0);
        let (mut low, mut high) = (-1.0, 2.0);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if value(table, &args, middle, b) < 0.0 { low = middle } else { high = middle }
        }
        low
    };
    let (mut levels, mut last) = (0, -1.0);
    for i in 1..1000 {
        let b = k * f64::from(i) / 1000.0;
        assert!((zero("round_union", None, b) - (k - (k * k - (k - b).powi(2)).sqrt())).abs() < 1e-9, "arc at {b}");
        assert!((zero("chamfer_union", None, b) - (k - b)).abs() < 1e-9, "bevel at {b}");
        // Arcs around points behind the bevel, of which neighbours meet at right angles.
        let (column, radius) = (zero("columns_union", Some(3.0), b), k / 2.0);
        let is_on_arc = [0.0, 1.0, 2.0].into_iter().any(|index| {
            let (x, y) = (index * radius - radius * 0.5f64.sqrt(), k - index * radius - radius * 0.5f64.sqrt());
            ((column - x).hypot(b - y) - radius).abs() < 1e-9
        });
        assert!(is_on_arc, "column at {b}");
        // Each of the three steps is level, from one multiple of k/4 to the next.
        let step = zero("stairs_union", Some(3.0), b);
        let rise = k / 4.0;
        assert!((step / rise - (step / rise).round()).abs() < 1e-6 || i % 250 == 0, "step {step} at {b}");
        if (step - last).abs() > 1e-6 && i % 250 != 0 {
            levels += 1;
            last = step;
        }
    }
    assert!(levels == 4 || levels == 3, "three steps and the upper face: {levels}");
}

#[test]
fn enclosures_are_no_wider_than_those_of_the_operands() {
    // Also over the corners of stairs, and where the operands are as far apart as the blend reaches.
    let mut random = Random::new(31);
    for (shape, table) in blends() {
        for &own in own(shape) {
            for k in [0.0, 0.4, 0.5] {
                let constants = (table.prepare)(&args(shape, k, own, 1.0));
                for _ in 0..300 {
                    let middle: f64 = random.range(-1.0, 1.0);
                    let gaps = [0.0, 0.1, 0.2, 0.25, 0.4, 0.5, random.range(0.0, 0.6)];
                    let gap = gaps[random.below(gaps.len())] * [1.0, -1.0][random.below(2)];
                    let radii = [1e-7, 1e-3, 0.05].map(|radius| radius * random.range(0.2, 1.0));
                    let (ra, rb) = (radii[random.below(3)], radii[random.below(3)]);
                    let (a, b) =
                        (middle, if shape.about.name.ends_with("difference") { gap - middle } else { middle + gap });
                    let [of_a, of_b] = [(a, ra), (b, rb)].map(|(x, r)| Interval::new(x - r, x + r));
                    let with = Constants::new(of_a, &constants[..], constants.len());
                    let enclosure = (table.kernels.interval)(of_a, of_b, &with);
                    let (value, widest) = (value(table, &args(shape, k, own, 1.0), a, b), 2.0 * ra.max(rb));
                    assert!(
                        enclosure.contains(value) && enclosure.width() <= widest * (1.0 + 1e-9) + 1e-12,
                        "{} {own:?} {k}: {enclosure:?} around {value} from {of_a:?} and {of_b:?}",
                        shape.about.name
                    );
                }
            }
        }
    }
}

#[test]
fn pipes_belong_to_the_farther_surface_on_either_side_of_both() {
    let Kind::Combine(table) = &shapes::PIPE.kind else { panic!("it combines") };
    let pairs =
        [[0.1, 0.2], [0.2, 0.1], [-0.1, 0.2], [-0.2, 0.1], [0.1, -0.2], [0.2, -0.1], [-0.1, -0.2], [-0.2, -0.1]];
    let shares: Vec<f32> = single(table, &[0.3], &pairs).into_iter().map(|[_, share]| share).collect();
    assert_eq!(shares, [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0], "1 where the second is farther away");
}
