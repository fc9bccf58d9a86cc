//! Random fields and points, and an independent membership test.
#![allow(dead_code, reason = "each test file uses a part")]

use freikugel_field::shape::Kind;
use freikugel_field::{Arity, Dimension, Field, Interval, Origin, ParamKind, Program, Shape, Value, analyse, shapes};
use glam::{DMat3, DQuat, DVec3};

pub(crate) mod inside;

/// A small seeded generator (xorshift64*).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    pub(crate) fn point(&mut self, reach: f64) -> DVec3 {
        DVec3::new(self.range(-reach, reach), self.range(-reach, reach), self.range(-reach, reach))
    }

    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.point(1.0);
            if v.length() > 0.1 && v.length() < 1.0 {
                return v.normalize();
            }
        }
    }
}

/// Random sound arguments for a kind of parameter.
fn arguments(kind: ParamKind, random: &mut Random, out: &mut Vec<Value>) {
    let mut push = |number: f64| out.push(number.into());
    let sign = if random.unit() < 0.5 { -1.0 } else { 1.0 };
    match kind {
        ParamKind::Number => push(random.range(-0.5, 0.5)),
        ParamKind::Length => push(if random.unit() < 0.3 { 0.0 } else { random.range(0.1, 0.4) }),
        ParamKind::Positive => push(random.range(0.2, 1.2)),
        ParamKind::Factor => push(sign * random.range(0.5, 2.0)),
        ParamKind::Count(least, most) => {
            push(f64::from(least + random.below((most.min(least + 9) - least) as usize) as u32));
        }
        ParamKind::Angle => push(random.range(-4.0, 4.0)),
        ParamKind::Choice(names) => push(random.below(names.len()) as f64),
        ParamKind::Flag => push(random.below(2) as f64),
        ParamKind::Vector => (0..3).for_each(|_| push(random.range(-1.0, 1.0))),
        ParamKind::Direction => random.direction().to_array().into_iter().for_each(push),
        ParamKind::Size => (0..3).for_each(|_| push(random.range(0.3, 2.0))),
        ParamKind::Lengths => {
            (0..3).for_each(|_| push(if random.below(3) == 0 { 0.0 } else { random.range(0.4, 2.0) }));
        }
        ParamKind::Points2 => {
            // A star-shaped polygon, with notches.
            let count = 3 + random.below(6);
            for corner in 0..count {
                let angle = std::f64::consts::TAU * (corner as f64 + random.range(0.0, 0.7)) / count as f64;
                let radius = random.range(0.3, 1.2);
                push(radius * angle.cos() + 0.1);
                push(radius * angle.sin());
            }
        }
        ParamKind::Numbers => (0..1 + random.below(4)).for_each(|_| push(random.range(-0.8, 0.8))),
        ParamKind::Points3 => (0..3 * (2 + random.below(4))).for_each(|_| push(random.range(-1.0, 1.0))),
        ParamKind::Balls => {
            for index in 0..2 + random.below(4) {
                (0..3).for_each(|_| push(random.range(-1.0, 1.0)));
                // A tip at the beginning, at times.
                push(if index == 0 && random.below(3) == 0 { 0.0 } else { random.range(0.1, 0.5) });
            }
        }
        ParamKind::Weighted => {
            for _ in 0..2 + random.below(4) {
                (0..3).for_each(|_| push(random.range(-1.0, 1.0)));
                push(random.range(0.3, 3.0));
            }
        }
        // Lists of them depend on how many points there are.
        ParamKind::Knots => push(random.below(ParamKind::KNOTS.len()) as f64),
        ParamKind::Net | ParamKind::WeightedNet => {
            // A sheet with bumps, in steps of this length along each side.
            const STEP: f64 = 0.7;
            let (rows, columns) = (2 + random.below(3), 2 + random.below(3));
            for place in 0..rows * columns {
                let (row, column) = (place / columns, place % columns);
                push(STEP * (row as f64 - (rows - 1) as f64 / 2.0) + random.range(-0.3, 0.3));
                push(STEP * (column as f64 - (columns - 1) as f64 / 2.0) + random.range(-0.3, 0.3));
                push(random.range(-0.8, 0.8));
                if kind == ParamKind::WeightedNet {
                    push(random.range(0.3, 3.0));
                }
                push(f64::from(u8::from(column + 1 == columns)));
            }
        }
        ParamKind::Contours => {
            // A round-edged star, in which smaller ones may be holes, or overlap.
            for reach in if random.below(2) == 0 { &[1.2][..] } else { &[1.2, 0.5][..] } {
                let count = 2 + random.below(5);
                for corner in 0..count {
                    let angle = std::f64::consts::TAU * (corner as f64 + random.range(0.0, 0.7)) / count as f64;
                    let radius = random.range(0.3, 1.0) * reach;
                    push(radius * angle.cos() + 0.1);
                    push(radius * angle.sin());
                    push(if count > 2 && random.below(2) == 0 { 0.0 } else { random.range(-2.0, 4.0) });
                    push(f64::from(u8::from(corner + 1 == count)));
                }
            }
        }
        ParamKind::Counts(least, _) => (0..3).for_each(|_| push(f64::from(least) + random.below(3) as f64)),
        ParamKind::Size2 => (0..2).for_each(|_| push(random.range(0.3, 2.0))),
        ParamKind::Factors => (0..3).for_each(|_| push(sign * random.range(0.5, 2.0))),
        ParamKind::Matrix => {
            let (turn, other) = (random.direction(), random.direction());
            let [turn, other] = [turn, other].map(|axis| DMat3::from_axis_angle(axis, random.range(0.0, 3.0)));
            let [x, y, z] = [0, 1, 2].map(|_| random.range(0.5, 2.0));
            let matrix = turn * DMat3::from_diagonal(DVec3::new(sign * x, y, z)) * other;
            matrix.transpose().to_cols_array().into_iter().for_each(push);
        }
        ParamKind::Angles => (0..3).for_each(|_| push(random.range(-4.0, 4.0))),
        ParamKind::Quaternion => (0..4).for_each(|_| push(random.range(-1.0, 1.0))),
        ParamKind::Quadruple => (0..4).for_each(|_| push(random.range(-0.6, 0.6))),
        ParamKind::Text => unreachable!("a text depends on what it is for"),
        ParamKind::Region => unreachable!("formulas have tests of their own"),
        ParamKind::HalfSpaces => {
            let tilt = DMat3::from_quat(DQuat::from_axis_angle(random.direction(), random.range(0.0, 3.0)));
            let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
            let more = random.below(5);
            let tilted = axes.map(|axis| tilt * axis);
            let others: Vec<DVec3> = (0..more).map(|_| random.direction()).collect();
            for normal in tilted.into_iter().chain(others) {
                normal.to_array().into_iter().for_each(&mut push);
                push(random.range(0.4, 1.0));
            }
        }
    }
}

/// Path data, and texts.
const PATHS: [&str; 3] = [
    "M-1 0.5 C-1 -0.7 -0.2 -0.7 0 0 C0.2 -0.7 1 -0.7 1 0.5 Q0 1 -1 0.5 Z M-0.3 0.3 h0.6 v0.3 h-0.6 z",
    "M0 -0.8 A0.8 0.8 0 1 1 -0.5 0.6 L0.2 0.1 Z",
    "M-1 -1 H1 V1 H-1 Z M-0.5 -0.5 V0.5 H0.5 V-0.5 Z",
];
const TEXTS: [&str; 3] = ["&a", "oi\n8", "Ä"];
const FORMULAS: [&str; 4] = ["sin(5 * x) / 3", "abs(x - 0.1) - 0.4", "sqrt(0.6 - x)", "0.2"];
const PICTURES: [&str; 2] = [
    "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0H2V1H1Z'/><circle r='1' fill='none' stroke='red'/></svg>",
    "<svg xmlns='http://www.w3.org/2000/svg'><rect width='2' height='1' rx='0.3' transform='rotate(20)'/></svg>",
];

/// A random sound call of `shape` that is a body if there are such, with children of depth below `depth`.
pub(crate) fn call(shape: &'static Shape, depth: u32, random: &mut Random) -> Field {
    call_in(Dimension::Space, shape, depth, random)
}

fn call_in(dimension: Dimension, shape: &'static Shape, depth: u32, random: &mut Random) -> Field {
    call_over(dimension, shape, 1, random, |dimension, random| tree_in(dimension, depth, random))
}

/// A random sound call over children that are made as often as `tries` calls over the same ones are all unsound.
fn call_over(
    dimension: Dimension,
    shape: &'static Shape,
    tries: usize,
    random: &mut Random,
    child: impl Fn(Dimension, &mut Random) -> Field,
) -> Field {
    let children_in = match &shape.kind {
        Kind::Product(_) | Kind::Loft | Kind::PerimeterSweep => Dimension::Plane,
        Kind::Map(table) if !table.is_planar => table.takes,
        _ => dimension,
    };
    let mut children: Vec<Field> = Vec::new();
    for attempt in 0..1000 {
        let args = random_arguments(shape, random);
        if attempt % tries == 0 {
            let count = match shape.arity() {
                Arity::None => 0,
                Arity::One => 1,
                Arity::Many => 2 + random.below(2),
            };
            children = (0..count).map(|_| child(children_in, random)).collect();
        }
        let material = matches!(shape.kind, Kind::Paint).then(|| freikugel_field::MaterialId(random.below(3) as u32));
        let field = Field::with_origin(shape, args, children.clone(), material, Origin::Document(0));
        if analyse(&field).0.is_some() {
            return field;
        }
    }
    panic!("no sound call of {} found", shape.about.name);
}

/// Random arguments of a shape, each sound by itself.
fn random_arguments(shape: &Shape, random: &mut Random) -> Vec<Value> {
    let mut args = Vec::new();
    for param in shape.about.params {
        if ["order", "exponent"].contains(&param.name) && param.kind == ParamKind::Positive {
            // Of a polynomial, which is any number above 1, or of a superellipse.
            args.push(random.range(1.2, 4.0).into());
        } else if param.name == "tolerance" {
            // Few triangles are triangles, too.
            args.push(random.range(0.1, 0.4).into());
        } else if param.kind == ParamKind::Text {
            let known = match param.name {
                "d" => &PATHS[..],
                "picture" => &PICTURES[..],
                "f" => &FORMULAS[..],
                _ => &TEXTS[..],
            };
            args.extend(known[random.below(known.len())].chars().map(|c| Value::from(u32::from(c))));
        } else {
            arguments(param.kind, random, &mut args);
        }
    }
    args
}

/// Whether the values of a shape are distances or bounds of them. What needs formulas or warps space has tests of its own.
pub(crate) fn is_measured(shape: &Shape) -> bool {
    match &shape.kind {
        Kind::Formula | Kind::Warp | Kind::Displace | Kind::Twist | Kind::Loft => false,
        Kind::Map(table) => table.is_short,
        _ => true,
    }
}

/// Whether a shape can be a body, or a figure. Maps that hardly ever keep a figure in its plane are left out.
fn can_be(shape: &Shape, dimension: Dimension) -> bool {
    match (&shape.kind, dimension) {
        (Kind::Primitive(table), _) => table.dimension == dimension,
        (Kind::Product(_) | Kind::PerimeterSweep, _) => dimension == Dimension::Space,
        (Kind::Map(table), _) => table.gives == dimension || table.is_planar,
        (Kind::Copies(_), Dimension::Plane) => shape.about.name == "repeat",
        (Kind::Place(_), Dimension::Plane) => ["scale", "stretch"].contains(&shape.about.name),
        _ => true,
    }
}

/// Checks that enclosures hold the values of random points of boxes of all sizes, and that those of small boxes, by half of their
/// edges, are no wider than `widest` says.
pub(crate) fn ranges_hold(program: &Program, boxes: i32, widest: impl Fn(f64) -> f64, random: &mut Random) {
    const SMALL: f64 = 1e-3;
    for step in 0..boxes {
        let (middle, half) = (random.point(1.5), 10.0_f64.powi(-(step % 7)));
        let enclosure = program.interval(middle.to_array().map(|x| Interval::new(x - half, x + half)));
        for p in (0..20).map(|_| middle + random.point(half)) {
            let value = program.value(p);
            assert!(enclosure.contains(value), "{value} at {p} in {enclosure:?}");
        }
        assert!(half > SMALL || enclosure.width() < widest(half), "{enclosure:?} for {half}");
    }
}

/// All shapes whose values are distances or bounds of them.
fn measured() -> impl Iterator<Item = &'static Shape> {
    shapes::ALL.iter().copied().filter(|shape| is_measured(shape))
}

/// A random sound field with at most `depth` operators above a primitive.
pub(crate) fn tree(depth: u32, random: &mut Random) -> Field {
    tree_in(Dimension::Space, depth, random)
}

fn tree_in(dimension: Dimension, depth: u32, random: &mut Random) -> Field {
    let fits = |shape: &&'static Shape| can_be(shape, dimension) && (depth > 0 || shape.arity() == Arity::None);
    let choices: Vec<_> = measured().filter(fits).collect();
    let shape = choices[random.below(choices.len())];
    call_in(dimension, shape, depth.saturating_sub(1), random)
}

/// A random sound body of at least so many calls.
pub(crate) fn large_tree(count: usize, random: &mut Random) -> Field {
    // Branches are seldom all as large as they may be.
    let sizes = (0..).map(|attempt| count + attempt * count / 8);
    let mut trees = sizes.map(|size| grown(Dimension::Space, size, random));
    trees.find(|tree| calls(tree) >= count).expect("some tree is large enough")
}

fn grown(dimension: Dimension, calls: usize, random: &mut Random) -> Field {
    if calls < 2 {
        return tree_in(dimension, 0, random);
    }
    // Copies of large trees would be too many to look at.
    let is_small = |shape: &Shape| calls < 4 || !matches!(shape.kind, Kind::Copies(_) | Kind::Endless { .. });
    let fits = |shape: &&'static Shape| can_be(shape, dimension) && shape.arity() != Arity::None && is_small(shape);
    let choices: Vec<_> = measured().filter(fits).collect();
    let shape = choices[random.below(choices.len())];
    let share = if shape.arity() == Arity::One { calls - 1 } else { (calls - 1) * 2 / 5 };
    call_over(dimension, shape, 50, random, |dimension, random| grown(dimension, share, random))
}

/// How many calls a field consists of.
pub(crate) fn calls(field: &Field) -> usize {
    1 + field.node().children.iter().map(calls).sum::<usize>()
}

/// A field on one line.
pub(crate) fn notation(field: &Field) -> String {
    let node = field.node();
    let children: Vec<String> = node.children.iter().map(notation).collect();
    format!("{}{:?}({})", node.shape.about.name, node.numbers(), children.join(", "))
}

/// Fields that exercise every shape: several random calls of each, over primitives.
pub(crate) fn every_shape(calls: u64) -> impl Iterator<Item = (&'static str, u64, Field)> {
    measured().flat_map(move |shape| {
        (0..calls).map(move |seed| (shape.about.name, seed, call(shape, 0, &mut Random::new(seed + 1))))
    })
}

/// Whether a shape is the union, intersection or difference of a family of blends.
pub(crate) fn is_blend(name: &str) -> bool {
    let families = ["round", "chamfer", "exponential", "polynomial", "stairs", "columns", "root"];
    let operators = ["union", "intersection", "difference"];
    name.split_once('_').is_some_and(|(family, operator)| families.contains(&family) && operators.contains(&operator))
}

/// Whether a shape is made where the surfaces of others meet, or mixes their distances.
pub(crate) fn is_carved(name: &str) -> bool {
    ["pipe", "engrave", "groove", "tongue", "morph"].contains(&name)
}
