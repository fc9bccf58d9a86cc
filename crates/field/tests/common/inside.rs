//! What lies inside of shapes, by set logic and the definition of each, never by its distance.

use super::{is_blend, is_carved};
use freikugel_field::shape::Kind;
use freikugel_field::{Extent, Field, extent, shapes};
use glam::{DMat3, DQuat, DVec2, DVec3, DVec4};

/// Whether a point lies in a field's shape, from set logic and each primitive's own definition, never from its distance.
/// `None` where the answer depends on a blend, or there is no inside.
pub(crate) fn contains(field: &Field, p: DVec3) -> Option<bool> {
    let node = field.node();
    let args = node.numbers();
    let mut children = node.children.iter();
    let p = match node.axis().filter(|_| !matches!(node.shape.kind, Kind::Copies(_))) {
        Some(0) => DVec3::new(p.y, p.z, p.x),
        Some(1) => DVec3::new(p.z, p.x, p.y),
        _ => p,
    };
    let across = p.x.hypot(p.y);
    Some(match (node.shape.about.name, args.as_slice()) {
        ("sphere", [r]) => p.length_squared() < r * r,
        ("circle", [r]) => across < *r,
        ("rectangle", [x, y, round]) => {
            let core = DVec2::new(*x, *y) / 2.0 - *round;
            let p = p.truncate();
            let nearest = p.clamp(-core, core);
            p == nearest || p.distance(nearest) < *round
        }
        ("ring", [outer, inner]) => across < *outer && across > *inner,
        ("ellipse", [x, y]) => (p.x / x).powi(2) + (p.y / y).powi(2) < 1.0,
        ("parabola", [width, height]) => {
            p.y < height / 2.0 && p.y + height / 2.0 > height * (2.0 * p.x / width).powi(2)
        }
        ("hyperbola", [width, height, radius]) => {
            // y^2 / a^2 - x^2 / b^2 > 1 beyond the centre, by the radius b^2 / a and the upper corners.
            let (v, half) = (p.y + height / 2.0, width / 2.0);
            let bend = (half * half / radius - 2.0 * height) / (height * height);
            v > 0.0 && v < *height && 2.0 * v + bend * v * v > p.x * p.x / radius
        }
        ("polygon", corners) => winds_around(corners, p),
        ("star", [tips, outer, inner]) => {
            let corners: Vec<f64> = (0..2 * *tips as usize)
                .flat_map(|index| {
                    let angle = std::f64::consts::PI * index as f64 / tips;
                    let radius = if index % 2 == 0 { outer } else { inner };
                    [radius * angle.sin(), radius * angle.cos()]
                })
                .collect();
            winds_around(&corners, p)
        }
        ("outline", corners) => crossings(corners, p.truncate()) % 2 == 1,
        ("sector", [radius, angle]) => across < *radius && from_y_axis(p) < angle / 2.0,
        ("ring_sector", [outer, inner, angle]) => across < *outer && across > *inner && from_y_axis(p) < angle / 2.0,
        ("arc", [radius, width, angle]) => {
            let turn = from_y_axis(p).min(angle / 2.0);
            let nearest = DVec2::new(turn.sin(), turn.cos()) * *radius;
            DVec2::new(p.x.abs(), p.y).distance(nearest) < width / 2.0
        }
        ("circle_segment", [radius, height]) => across < *radius && p.y > *height,
        ("lens", [width, height]) => {
            // The circle through both tips and the end of the other axis.
            let offset = (height * height - width * width) / (4.0 * width);
            p.x.abs().powi(2) + 2.0 * p.x.abs() * offset + p.y * p.y < height * height / 4.0
        }
        ("moon", [outer, inner, distance]) => {
            across < *outer && p.truncate().distance(DVec2::new(*distance, 0.0)) > *inner
        }
        ("horseshoe", [radius, width, angle, length]) => {
            let q = DVec2::new(p.x.abs(), -p.y);
            let is_on_arc = (across - radius).abs() < width / 2.0 && q.x.atan2(q.y) < angle / 2.0;
            // The leg in coordinates along the radius at its foot, and along itself.
            let (out, on) = (DVec2::new((angle / 2.0).sin(), (angle / 2.0).cos()), angle / 2.0);
            let along = DVec2::new(on.cos(), -on.sin());
            is_on_arc || ((q.dot(out) - radius).abs() < width / 2.0 && q.dot(along) > 0.0 && q.dot(along) < *length)
        }
        ("uneven_capsule", [bottom, top, height]) => {
            let at = |share: f64| {
                p.truncate().distance(DVec2::new(0.0, height * (share - 0.5))) - (bottom + (top - bottom) * share)
            };
            least(at) < 0.0
        }
        ("heart", [width]) => {
            // In units of the square's side, from its lower corner, along two of its sides.
            let side = width / (1.0 + 0.5_f64.sqrt());
            let bottom = -(side / 2.0_f64.sqrt() + side * (0.5 / 2.0_f64.sqrt() + 0.5)) / 2.0;
            let q = DVec2::new(p.x.abs() + (p.y - bottom), (p.y - bottom) - p.x.abs()) / (2.0_f64.sqrt() * side);
            (q.max_element() < 1.0 && q.min_element() > 0.0) || q.distance(DVec2::new(1.0, 0.5)) < 0.5
        }
        ("arch", [width, height]) => {
            let middle = (height - width) / 2.0;
            (p.x.abs() < width / 2.0 && p.y > -height / 2.0 && p.y <= middle)
                || (p.y > -height / 2.0 && p.truncate().distance(DVec2::new(0.0, middle)) < width / 2.0)
        }
        ("cross", [size, width, round]) => {
            let bar = |long: f64, short: f64| {
                let core = DVec2::new(size / 2.0 - round, width / 2.0 - round);
                let q = DVec2::new(long.abs(), short.abs());
                (q - core).max(DVec2::ZERO).length() < *round
                    || (q.cmplt(core).all())
                    || (q.x < size / 2.0 - round && q.y < width / 2.0)
            };
            bar(p.x, p.y) || bar(p.y, p.x)
        }
        ("egg", [bottom, top]) => {
            let (q, reach) = (DVec2::new(p.x.abs(), p.y), bottom - top);
            let tip = DVec2::new(0.0, 3.0_f64.sqrt() * reach);
            match q {
                q if q.y <= 0.0 => q.length() < *bottom,
                // Above the line from the middle of the arc at the side through that of the tip.
                q if 3.0_f64.sqrt() * (q.x + reach) < q.y => q.distance(tip) < *top,
                q => q.distance(DVec2::new(-reach, 0.0)) < 2.0 * reach + top,
            }
        }
        ("rhombus", [x, y]) => p.x.abs() / (x / 2.0) + p.y.abs() / (y / 2.0) < 1.0,
        ("trapezoid", [bottom, top, height]) => {
            let share = p.y / height + 0.5;
            (0.0..1.0).contains(&share) && 2.0 * p.x.abs() < bottom + (top - bottom) * share
        }
        ("parallelogram", [width, height, skew]) => {
            p.y.abs() < height / 2.0 && (p.x - skew * p.y / height).abs() < width / 2.0
        }
        ("chamfered_rectangle", [x, y, chamfer]) => {
            let q = DVec2::new(x / 2.0, y / 2.0) - p.truncate().abs();
            q.min_element() > 0.0 && q.x + q.y > *chamfer
        }
        ("staircase", [width, height, steps]) => {
            let (x, y) = (p.x / width + 0.5, p.y / height + 0.5);
            x > 0.0 && x < 1.0 && y > 0.0 && y < (x * steps).ceil() / steps
        }
        ("tetrahedron", [radius]) => {
            let edge = 3.0_f64.sqrt() / radius;
            let q = p * edge;
            (q.x + q.y - q.z).max(q.x - q.y + q.z).max(-q.x + q.y + q.z).max(-q.x - q.y - q.z) < 1.0
        }
        ("dodecahedron", [radius]) => {
            let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
            let q = p.abs();
            // The corner (1, 1, 1) lies on these faces.
            let limit = radius / 3.0_f64.sqrt() * (1.0 + golden);
            (golden * q.x + q.y).max(golden * q.y + q.z).max(golden * q.z + q.x) < limit
        }
        ("icosahedron", [radius]) => {
            let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
            let q = p.abs();
            // The corner (0, 1, golden) lies on these faces.
            let limit = radius / (1.0 + golden * golden).sqrt() * (1.0 + golden);
            let others = [(q.y, q.z), (q.z, q.x), (q.x, q.y)];
            q.element_sum() < limit && others.iter().all(|(a, b)| a * golden + b / golden < limit)
        }
        ("truncated_octahedron", [radius]) => p.abs().max_element() < *radius && p.abs().element_sum() < 1.5 * radius,
        ("chamfered_box", [x, y, z, chamfer]) => {
            let q = DVec3::new(*x, *y, *z) / 2.0 - p.abs();
            q.min_element() > 0.0 && (q.x + q.y).min(q.y + q.z).min(q.z + q.x) > *chamfer
        }
        ("pyramid", [x, y, height, top]) => {
            let share = p.z / height + 0.5;
            let size = 1.0 + (top - 1.0) * share;
            (0.0..1.0).contains(&share) && p.x.abs() < x / 2.0 * size && p.y.abs() < y / 2.0 * size
        }
        ("wedge", [x, y, z]) => p.x > -x / 2.0 && p.y.abs() < y / 2.0 && p.z > -z / 2.0 && p.x / x + p.z / z < 0.0,
        ("regular_polygon", [sides, radius, round]) => {
            // Within the smaller polygon, or near one of its corners or sides.
            let step = std::f64::consts::PI / sides;
            let core = radius - round / step.cos();
            let corner =
                |index: usize| DVec2::from_angle(2.0 * step * index as f64 + std::f64::consts::FRAC_PI_2) * core;
            let p = p.truncate();
            (0..*sides as usize).all(|i| (corner(i) + corner(i + 1)).normalize().dot(p) < core * step.cos())
                || (0..*sides as usize).any(|i| {
                    let (a, b) = (corner(i), corner(i + 1));
                    let share = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                    p.distance(a.lerp(b, share)) < *round
                })
        }
        ("box_frame", [x, y, z, thickness]) => {
            let inner = p.abs() - DVec3::new(*x, *y, *z) / 2.0;
            inner.max_element() < 0.0 && inner.to_array().into_iter().filter(|&side| side > -thickness).count() >= 2
        }
        ("link", [length, major, minor, _]) => {
            let end = (p.z.abs() - length / 2.0).max(0.0);
            let on_ring = DVec3::new(p.x, 0.0, end).normalize_or(DVec3::X) * *major;
            DVec3::new(p.x, p.y, end).distance(on_ring) < *minor
        }
        ("capped_torus", [angle, major, minor, _]) => {
            let turn = p.y.atan2(p.x).clamp(-angle / 2.0, angle / 2.0);
            p.distance(DVec3::new(turn.cos(), turn.sin(), 0.0) * *major) < *minor
        }
        ("octahedron", [radius]) => p.abs().element_sum() < *radius,
        ("round_cone", [bottom, top, height, _]) => {
            // How far outside of a sphere the point lies has one minimum over all spheres.
            let at = |share: f64| {
                p.distance(DVec3::new(0.0, 0.0, height * (share - 0.5))) - (bottom + (top - bottom) * share)
            };
            least(at) < 0.0
        }
        ("cut_sphere", [radius, height, _]) => p.length() < *radius && p.z > *height,
        ("solid_angle", [angle, radius, _]) => p.length() < *radius && p.angle_between(DVec3::Z) < *angle,
        ("slab", [thickness, _]) => p.z.abs() < thickness / 2.0,
        ("extrude", [height, round]) if *round == 0.0 => contains(children.next()?, p)? && p.z.abs() < height / 2.0,
        ("extrude", _) => return None,
        ("revolve", [offset]) => contains(children.next()?, DVec3::new(across - offset, p.z, 0.0))?,
        ("repeat" | "repeat_polar" | "repeat_varied" | "scatter", _) => {
            all(freikugel_field::copies(field)?.iter().map(|copy| contains(copy, p)))?.into_iter().any(|copy| copy)
        }
        ("repeat_mirrored", spacing) => {
            // From cell to cell towards the middle.
            let mut q = p;
            for axis in (0..3).filter(|&axis| spacing[axis] > 0.0) {
                while q[axis].abs() > spacing[axis] / 2.0 {
                    q[axis] = spacing[axis] * q[axis].signum() - q[axis];
                }
            }
            contains(children.next()?, q)?
        }
        ("perimeter_sweep", _) => return None,
        ("revolve_part", [angle, offset]) => {
            p.y.atan2(p.x).abs() < angle / 2.0 && contains(children.next()?, DVec3::new(across - offset, p.z, 0.0))?
        }
        ("cross_section", [height]) => contains(children.next()?, DVec3::new(p.x, p.y, *height))?,
        ("repeat_endless", spacing) => {
            // All copies whose boxes hold the point; along other axes the shape may have no end.
            let child = children.next()?;
            let Extent::Finite(bounds) = extent(&(child.clone() & shapes::cuboid([1e6; 3]))) else {
                return Some(false);
            };
            let copies = |axis: usize| match spacing[axis] {
                0.0 => 0..=0,
                s => {
                    ((p[axis] - bounds.max[axis]) / s).floor() as i32..=((p[axis] - bounds.min[axis]) / s).ceil() as i32
                }
            };
            let cells = copies(0).flat_map(|x| copies(1).flat_map(move |y| copies(2).map(move |z| [x, y, z])));
            let copy = |cell: [i32; 3]| p - DVec3::from_slice(spacing) * DVec3::from(cell.map(f64::from));
            all(cells.map(|cell| contains(child, copy(cell))))?.into_iter().any(|copy| copy)
        }
        ("symmetry", [axes, k]) => {
            let folded = *axes as usize + 1;
            // A parabola that touches the absolute value at k.
            let smooth = |x: f64| if x.abs() < *k { (x * x / k + k) / 2.0 } else { x.abs() };
            let fold = |axis: usize| if folded >> axis & 1 == 1 { smooth(p[axis]) } else { p[axis] };
            contains(children.next()?, DVec3::new(fold(0), fold(1), fold(2)))?
        }
        ("elongate", [x, y, z]) => {
            let half = DVec3::new(*x, *y, *z) / 2.0;
            contains(children.next()?, p - p.clamp(-half, half))?
        }
        ("plane", [x, y, z, d]) => DVec3::new(*x, *y, *z).normalize().dot(p) < *d,
        ("sheet" | "disc" | "triangle" | "quad", _) => return None,
        ("box", [x, y, z, round]) => {
            let core = DVec3::new(*x, *y, *z) / 2.0 - *round;
            let nearest = p.clamp(-core, core);
            p == nearest || p.distance(nearest) < *round
        }
        ("torus", [major, minor, _]) => {
            let on_circle = DVec3::new(p.x, p.y, 0.0).normalize_or(DVec3::X) * *major;
            p.distance(on_circle) < *minor
        }
        ("cylinder", [radius, height, round, _]) => {
            let (side, end) = (across - (radius - round), p.z.abs() - (height / 2.0 - round));
            if side <= 0.0 || end <= 0.0 { side < *round && end < *round } else { side.hypot(end) < *round }
        }
        ("cone", [bottom, top, height, _]) => {
            let share = p.z / height + 0.5;
            (0.0..1.0).contains(&share) && across < bottom + (top - bottom) * share
        }
        ("capsule", [a, b, c, d, e, f, r]) => {
            let (from, to) = (DVec3::new(*a, *b, *c), DVec3::new(*d, *e, *f));
            // The squared distance along the segment has one minimum.
            let at = |share: f64| p.distance_squared(from.lerp(to, share));
            least(at) < r * r
        }
        ("ellipsoid" | "ellipsoid_bound", [x, y, z]) => (p / DVec3::new(*x, *y, *z)).length_squared() < 1.0,
        ("quaternion_julia", args) => julia_contains(args, p),
        ("mandelbulb", args) => mandelbulb_contains(args, p),
        ("convex_polyhedron" | "convex_polyhedron_bound", planes) => {
            planes.chunks(4).all(|h| DVec3::from_slice(h).normalize().dot(p) < h[3])
        }
        ("union", _) => all(children.map(|c| contains(c, p)))?.into_iter().any(|c| c),
        ("intersection", _) => all(children.map(|c| contains(c, p)))?.into_iter().all(|c| c),
        ("difference", _) => {
            let inside = all(children.map(|c| contains(c, p)))?;
            inside[0] && !inside[1..].iter().any(|&c| c)
        }
        ("xor", _) => all(children.map(|c| contains(c, p)))?.into_iter().filter(|&c| c).count() % 2 == 1,
        ("complement", _) => !contains(children.next()?, p)?,
        ("paint", _) => contains(children.next()?, p)?,
        ("translate", [x, y, z]) => contains(children.next()?, p - DVec3::new(*x, *y, *z))?,
        ("rotate", [x, y, z, angle]) => {
            let turn = DQuat::from_axis_angle(DVec3::new(*x, *y, *z).normalize(), -angle);
            contains(children.next()?, turn * p)?
        }
        ("rotate_euler", [x, y, z]) => {
            // The inverse of Rz Ry Rx, one turn after another.
            let p = DMat3::from_rotation_z(-z) * p;
            let p = DMat3::from_rotation_y(-y) * p;
            contains(children.next()?, DMat3::from_rotation_x(-x) * p)?
        }
        ("rotate_quaternion", [x, y, z, w]) => {
            let q = DQuat::from_xyzw(*x, *y, *z, *w).normalize();
            contains(children.next()?, q.conjugate() * p)?
        }
        ("reflect", [x, y, z, d]) => {
            let n = DVec3::new(*x, *y, *z).normalize();
            contains(children.next()?, p - n * (2.0 * (n.dot(p) - d)))?
        }
        ("scale", [a]) => contains(children.next()?, p / *a)?,
        ("stretch", [x, y, z]) => contains(children.next()?, p / DVec3::new(*x, *y, *z))?,
        ("shear", [plane, by]) => {
            let [moved, with] = [[0, 1], [0, 2], [1, 0], [1, 2], [2, 0], [2, 1]][*plane as usize];
            let mut q = p;
            q[moved] -= by * p[with];
            contains(children.next()?, q)?
        }
        ("matrix", args) => {
            // By Cramer's rule.
            let [a, b, c] = [0, 3, 6].map(|at| DVec3::from_slice(&args[at..]));
            let volume = a.dot(b.cross(c));
            let q = p - DVec3::from_slice(&args[9..]);
            contains(children.next()?, (b.cross(c) * q.x + c.cross(a) * q.y + a.cross(b) * q.z) / volume)?
        }
        ("align", args) => {
            // Two half turns about the new direction, and the middle between both, make the turn.
            let (from, to) = (DVec3::from_slice(args).normalize(), DVec3::from_slice(&args[3..]).normalize());
            let half_turn = |axis: DVec3, p: DVec3| 2.0 * axis * axis.dot(p) - p;
            let q = half_turn(from, half_turn((from + to).normalize(), p));
            contains(children.next()?, q)?
        }
        ("tube", [radius, closed, points @ ..]) => {
            let points: Vec<DVec3> = points.chunks_exact(3).map(DVec3::from_slice).collect();
            near_line(&points, *closed == 1.0, p, *radius)
        }
        ("tapered_tube", [closed, balls @ ..]) => {
            let balls: Vec<DVec4> = balls.chunks_exact(4).map(DVec4::from_slice).collect();
            (0..balls.len() - usize::from(*closed != 1.0)).any(|index| {
                let (a, b) = (balls[index], balls[(index + 1) % balls.len()]);
                // How far outside of a ball the point lies has one minimum over all balls.
                let at = |share: f64| p.distance(a.lerp(b, share).truncate()) - a.lerp(b, share).w;
                least(at) < 0.0
            })
        }
        ("point_set", [radius, points @ ..]) => {
            points.chunks_exact(3).any(|c| p.distance(DVec3::from_slice(c)) < *radius)
        }
        ("smooth_point_set", [radius, k, points @ ..]) => {
            let depth = |c: &[f64]| (radius + k - p.distance(DVec3::from_slice(c))).max(0.0);
            points.chunks_exact(3).map(|c| depth(c).powi(2)).sum::<f64>() > k * k
        }
        ("polyline", [width, closed, points @ ..]) => {
            let points: Vec<DVec3> = points.chunks_exact(2).map(|c| DVec3::new(c[0], c[1], 0.0)).collect();
            near_line(&points, *closed == 1.0, DVec3::new(p.x, p.y, 0.0), width / 2.0)
        }
        ("offset" | "shell" | "smooth_union" | "smooth_intersection" | "smooth_difference", _) => {
            return None;
        }
        // Tested by themselves: what is inside, their own curves say.
        ("superellipse" | "gear" | "spiral" | "logarithmic_spiral" | "clothoid", _) => return None,
        ("text" | "svg" | "svg_path" | "bezier" | "b_spline" | "spline", _) => return None,
        (
            "stroke"
            | "graph"
            | "under_graph"
            | "formula_graph"
            | "under_formula_graph"
            | "nurbs"
            | "tapered_bezier"
            | "tapered_b_spline"
            | "tapered_spline"
            | "sweep",
            _,
        ) => return None,
        ("bezier_patch" | "b_spline_patch" | "nurbs_patch", _) => return None,
        (name, _) if is_blend(name) || is_carved(name) => return None,
        (name, args) => panic!("say in the membership test what lies inside {name} with {} numbers", args.len()),
    })
}

/// The least value between 0 and 1 of a function that has one minimum there: closes in on it from both sides.
fn least(at: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if at(low + third) < at(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    at(low)
}

/// Whether a point is nearer than `radius` to some point of a line.
fn near_line(points: &[DVec3], is_closed: bool, p: DVec3, radius: f64) -> bool {
    let count = points.len() - usize::from(!is_closed);
    (0..count).any(|index| {
        let (a, b) = (points[index], points[(index + 1) % points.len()]);
        // The squared distance along a piece is a parabola: at its ends, or at its vertex between them.
        let [start, middle, end] = [0.0, 0.5, 1.0].map(|share| p.distance_squared(a.lerp(b, share)));
        let bend = 2.0 * (start - 2.0 * middle + end);
        let vertex = ((start - end) / (2.0 * bend) + 0.5).clamp(0.0, 1.0);
        p.distance(a.lerp(b, vertex)) < radius
    })
}

/// The angle between a point of the plane and the y axis, from 0 to half a turn.
fn from_y_axis(p: DVec3) -> f64 {
    p.x.abs().atan2(p.y)
}

/// How many edges of an outline a ray from a point meets that leads in no special direction.
fn crossings(corners: &[f64], p: DVec2) -> usize {
    let ray = DVec2::from_angle(0.7345);
    let corners: Vec<&[f64]> = corners.chunks_exact(4).collect();
    let (mut count, mut first) = (0, 0);
    for (index, corner) in corners.iter().enumerate() {
        let next = if corner[3] == 1.0 { std::mem::replace(&mut first, index + 1) } else { index + 1 };
        let (a, b, turn) = (DVec2::from_slice(corner), DVec2::from_slice(corners[next]), corner[2]);
        if turn == 0.0 {
            let normal = (b - a).perp();
            let t = (a - p).dot(normal) / ray.dot(normal);
            let share = (p + ray * t - a).dot(b - a) / (b - a).length_squared();
            count += usize::from(t > 0.0 && (0.0..1.0).contains(&share));
            continue;
        }
        // From the middle of the arc's circle, by turning the chord: its ends lie at minus and plus half the angle.
        let middle = (a + b) / 2.0 + (b - a).perp() / 2.0 / (turn / 2.0).tan();
        let (q, radius) = (p - middle, a.distance(middle));
        let root = q.dot(ray).powi(2) - q.length_squared() + radius * radius;
        for t in [-1.0, 1.0].map(|sign| -q.dot(ray) + sign * root.sqrt()).into_iter().filter(|&t| t > 0.0) {
            let from_start = (a - middle).angle_to(q + ray * t) * turn.signum();
            let from_start = from_start.rem_euclid(std::f64::consts::TAU);
            count += usize::from(from_start < turn.abs());
        }
    }
    count
}

/// Whether a point lies inside a polygon an odd number of times: the angles under which its edges are seen make whole turns.
fn winds_around(corners: &[f64], p: DVec3) -> bool {
    let corners: Vec<DVec2> = corners.chunks_exact(2).map(|corner| DVec2::from_slice(corner) - p.truncate()).collect();
    let turn = |index: usize| corners[index].angle_to(corners[(index + 1) % corners.len()]);
    let turns: f64 = (0..corners.len()).map(turn).sum();
    (turns / std::f64::consts::TAU).round() as i64 % 2 != 0
}

fn all(answers: impl Iterator<Item = Option<bool>>) -> Option<Vec<bool>> {
    answers.collect()
}

/// Whether the orbit of the quaternion (p, w) under q^k + c stays within the bailout radius, by quaternion products.
pub(crate) fn julia_contains(args: &[f64], p: DVec3) -> bool {
    let (c, power, iterations, bailout, w) = (&args[..4], args[4], args[5], args[6], args[7]);
    let length = |q: &[f64]| q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let bailout = bailout.max(escape_radius(power, length(c)));
    let start = [p.x, p.y, p.z, w];
    let mut q = start;
    for _ in 0..iterations as u32 {
        let base = q;
        for _ in 1..power as u32 {
            let [a, i, j, k] = q;
            let [b, x, y, z] = base;
            q = [
                a * b - i * x - j * y - k * z,
                a * x + i * b + j * z - k * y,
                a * y - i * z + j * b + k * x,
                a * z + i * y - j * x + k * b,
            ];
        }
        q = std::array::from_fn(|part| q[part] + c[part]);
        // Beyond the bailout radius there is no way back.
        if length(&q) > bailout {
            return false;
        }
    }
    length(&start) <= bailout
}

/// Whether the orbit of p under the power that multiplies polar angles, plus p, stays within the bailout radius.
pub(crate) fn mandelbulb_contains(args: &[f64], p: DVec3) -> bool {
    let (power, iterations, bailout) = (args[0], args[1], args[2]);
    let bailout = bailout.max(2.0_f64.powf(1.0 / (power - 1.0)));
    let mut q = p;
    for _ in 0..iterations as u32 {
        let (r, polar, around) = (q.length(), q.x.hypot(q.y).atan2(q.z) * power, q.y.atan2(q.x) * power);
        let direction = DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos());
        q = direction * r.powf(power) + p;
    }
    // Also where it is not a number any more.
    q.length() <= bailout
}

/// The least r with r^k - c >= r beyond it.
fn escape_radius(power: f64, c: f64) -> f64 {
    let (mut low, mut high) = (1.0_f64, 4.0_f64);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if middle.powf(power) - c < middle {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
