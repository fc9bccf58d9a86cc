//! What can be said about a field without evaluating it: its faults, its contract, its extent.
//!
//! Contracts are derived from the leaves upwards. Extents come from support functions: for each of the six axis
//! directions, the farthest a point of the shape can lie. A direction passes through affine maps exactly, so a rotated
//! torus gets its true box and not the box of a rotated box.

use crate::contract::{Aabb, Contract, Dimension, Extent};
use crate::diagnostic::{Diagnostic, Severity};
use crate::field::{Field, Node};
use crate::shape::{Arity, Hull, Kind};
use crate::shapes::{self, displace, formula, loft, perimeter_sweep, twist, warp};
use glam::{DAffine3, DMat3, DVec3};

/// The deepest nesting a field may have; deeper ones would exhaust the stack of a small thread.
pub const MAX_DEPTH: u32 = 512;

/// The most copies of a shape that one node makes: more would take seconds to compile.
pub const MOST_COPIES: usize = 100_000;

/// The copies that a repetition stands for, each as a shape of its own; `None` if the field is no repetition.
pub fn copies(field: &Field) -> Option<Vec<Field>> {
    let node = field.node();
    let Kind::Copies(table) = &node.shape.kind else { return None };
    let args = node.numbers();
    let copy = |index: usize| {
        let places = (table.places)(&args, index);
        places.into_iter().rev().fold(node.children[0].clone(), |inner, (shape, args)| {
            Field::with_origin(shape, args.into_iter().map(Into::into), [inner], None, node.origin)
        })
    };
    Some((0..(table.count)(&args)).map(copy).collect())
}

/// What is known about a field.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// How the field relates to the true distance.
    pub contract: Contract,
    /// The box that holds the shape.
    pub extent: Extent,
    /// How many nodes the tree has.
    pub nodes: usize,
    /// How many of them are primitives.
    pub primitives: usize,
}

/// Looks through a field. The analysis is there if no diagnostic is an error.
pub fn analyse(field: &Field) -> (Option<Analysis>, Vec<Diagnostic>) {
    let mut walk = Walk::default();
    if field.depth() > MAX_DEPTH {
        let message = format!("shapes are nested {} deep; at most {MAX_DEPTH} are possible", field.depth());
        walk.report(field.node(), Severity::Error, None, message, Some("join unions into one".into()));
        return (None, walk.diagnostics);
    }
    let contract = walk.visit(field);
    let analysis = contract.map(|contract| Analysis {
        contract,
        extent: extent(field),
        nodes: walk.nodes,
        primitives: walk.primitives,
    });
    (analysis, walk.diagnostics)
}

/// The contract of a field, if it is sound: what [`analyse`] says of it, without the extent.
pub(crate) fn contract(field: &Field) -> Option<Contract> {
    Walk::default().visit(field)
}

/// As [`analyse`], for what stands side by side in one scene: plane figures are an error among bodies.
pub fn analyse_together(fields: &[Field]) -> Vec<(Option<Analysis>, Vec<Diagnostic>)> {
    let analyses: Vec<_> = fields.iter().map(analyse).collect();
    let is_body = |(analysis, _): &(Option<Analysis>, _)| {
        analysis.as_ref().is_some_and(|analysis| analysis.contract.dimension == Dimension::Space)
    };
    if !analyses.iter().any(is_body) {
        return analyses;
    }
    fields.iter().zip(analyses).map(|(field, analysis)| as_body(field, analysis)).collect()
}

/// As [`analyse`], for what is to be a body by itself: a plane figure is an error.
pub fn analyse_body(field: &Field) -> (Option<Analysis>, Vec<Diagnostic>) {
    as_body(field, analyse(field))
}

/// What the analysis of a field comes to where only bodies may stand.
fn as_body(
    field: &Field,
    (analysis, mut diagnostics): (Option<Analysis>, Vec<Diagnostic>),
) -> (Option<Analysis>, Vec<Diagnostic>) {
    match analysis {
        Some(analysis) if analysis.contract.dimension == Dimension::Plane => {
            let node = field.node();
            diagnostics.push(Diagnostic {
                severity: Severity::Error,
                message: format!("`{}` makes a plane figure, which has no height", node.shape.about.name),
                hint: Some("make a body of it, with `extrude` or `revolve`".into()),
                origin: node.origin,
                param: None,
            });
            (None, diagnostics)
        }
        analysis => (analysis, diagnostics),
    }
}

#[derive(Default)]
struct Walk {
    diagnostics: Vec<Diagnostic>,
    nodes: usize,
    primitives: usize,
}

impl Walk {
    fn report(&mut self, node: &Node, severity: Severity, param: Option<usize>, message: String, hint: Option<String>) {
        self.diagnostics.push(Diagnostic { severity, message, hint, origin: node.origin, param });
    }

    fn error(&mut self, node: &Node, param: Option<usize>, message: String) -> Option<Contract> {
        self.report(node, Severity::Error, param, message, None);
        None
    }

    /// Reports that a plane figure stands where only a body can.
    fn no_body(&mut self, node: &Node) -> Option<Contract> {
        let message = format!("`{}` takes a body, not a plane figure", node.shape.about.name);
        let hint = Some("make a body of it first, with `extrude` or `revolve`".into());
        self.report(node, Severity::Error, None, message, hint);
        None
    }

    /// The contract of a field, or `None` after reporting an error in it.
    fn visit(&mut self, field: &Field) -> Option<Contract> {
        let node = field.node();
        let name = node.shape.about.name;
        self.nodes += 1;
        // All children are looked at, whatever is wrong here.
        let children: Vec<Option<Contract>> = node.children.iter().map(|child| self.visit(child)).collect();
        let sound = self.arguments_are_sound(node);
        match (node.shape.arity(), node.children.len()) {
            (Arity::None, 0) | (Arity::One, 1) | (Arity::Many, 1..) => {}
            (Arity::None, _) => return self.error(node, None, format!("`{name}` takes no shapes")),
            (Arity::One, _) => {
                return self.error(node, None, format!("`{name}` takes exactly one shape"));
            }
            (Arity::Many, _) => {
                let hint = Some("give at least one shape, or leave it out".into());
                self.report(node, Severity::Error, None, format!("`{name}` has no shapes"), hint);
                return None;
            }
        }
        if !(self.formulas_are_sound(node) && sound) {
            return None;
        }
        let args = node.numbers();
        match &node.shape.kind {
            Kind::Primitive(table) => {
                self.primitives += 1;
                if let Err(fault) = (table.check)(&args) {
                    return self.error(node, None, fault);
                }
                Some(Contract { dimension: table.dimension, ..(table.contract)(&args) })
            }
            Kind::Combine(table) => {
                let dimensions: Vec<Dimension> = children.iter().flatten().map(|child| child.dimension).collect();
                if dimensions.windows(2).any(|pair| pair[0] != pair[1]) {
                    let hint = Some("make bodies of figures first, with `extrude` or `revolve`".into());
                    let message = format!("`{name}` takes either plane figures or bodies, not both");
                    self.report(node, Severity::Error, None, message, hint);
                    return None;
                }
                let mut children = children.into_iter();
                let mut contract = children.next().flatten();
                for child in children {
                    contract = match (contract, child) {
                        (Some(a), Some(b)) => match (table.contract)(&args, a, b) {
                            Ok(both) => Some(both),
                            Err(fault) => return self.error(node, None, fault),
                        },
                        _ => None,
                    };
                }
                contract
            }
            Kind::Place(table) => {
                let child = children[0]?;
                if child.dimension == Dimension::Plane && !keeps_plane(&(table.map)(&args)) {
                    let message = format!("`{name}` takes a plane figure out of its plane");
                    let hint = Some("make a body of it first, with `extrude` or `revolve`".into());
                    self.report(node, Severity::Error, None, message, hint);
                    return None;
                }
                Some(if (table.is_similarity)(&args) { child } else { child.at_most_bound() })
            }
            Kind::Modify(table) => {
                let child = children[0]?;
                if let Some(doubt) = (table.warning)(&args, child) {
                    self.report(node, Severity::Warning, None, doubt, None);
                }
                match (table.contract)(&args, child) {
                    Ok(contract) => Some(Contract { dimension: child.dimension, ..contract }),
                    Err(fault) => self.error(node, None, fault),
                }
            }
            Kind::Copies(table) => {
                let child = children[0]?;
                let count = (table.count)(&args);
                if count > MOST_COPIES {
                    return self.error(
                        node,
                        None,
                        format!("`{name}` makes {count} copies; at most {MOST_COPIES} are possible"),
                    );
                }
                let is_plane = child.dimension == Dimension::Plane;
                if is_plane && !(0..count).all(|copy| keeps_plane(&table.map(&args, copy))) {
                    return self.error(node, None, format!("`{name}` takes a plane figure out of its plane"));
                }
                let Kind::Combine(union) = &shapes::UNION.kind else { unreachable!("union combines") };
                match (union.contract)(&[], child, child) {
                    Ok(contract) if count > 1 => Some(Contract { dimension: child.dimension, ..contract }),
                    Ok(_) => Some(child),
                    Err(fault) => self.error(node, None, fault),
                }
            }
            Kind::Map(table) | Kind::Endless { fold: table, .. } => {
                let child = children[0]?;
                let is_plane = child.dimension == Dimension::Plane;
                if table.takes == Dimension::Plane && !is_plane {
                    return self.error(node, None, format!("`{name}` takes a plane figure, not a body"));
                }
                if table.takes == Dimension::Space && is_plane && !table.is_planar {
                    return self.no_body(node);
                }
                let reach = |direction: DVec3| support(&node.children[0], direction, 0.0);
                match (table.contract)(&args, child, &reach) {
                    Ok(contract) => {
                        let dimension = if table.is_planar { child.dimension } else { table.gives };
                        Some(Contract { dimension, ..contract })
                    }
                    Err(fault) => self.error(node, None, fault),
                }
            }
            Kind::Product(table) => {
                let child = children[0]?;
                if child.dimension != Dimension::Plane {
                    return self.error(node, None, format!("`{name}` takes a plane figure, not a body"));
                }
                let reach = |direction: DVec3| support(&node.children[0], direction, 0.0);
                let figure = table.frame.as_ref().map_or(Ok(child), |frame| (frame.contract)(&args, child, &reach));
                match figure.and_then(|figure| (table.combine.contract)(&args, figure, Contract::EXACT)) {
                    Ok(contract) => Some(Contract { dimension: Dimension::Space, ..contract }),
                    Err(fault) => self.error(node, None, fault),
                }
            }
            Kind::Loft | Kind::PerimeterSweep => {
                let figures: Vec<Contract> = children.into_iter().collect::<Option<_>>()?;
                if figures.iter().any(|figure| figure.dimension != Dimension::Plane) {
                    return self.error(node, None, format!("`{name}` takes plane figures, not bodies"));
                }
                let contract =
                    if matches!(node.shape.kind, Kind::Loft) { loft::contract } else { perimeter_sweep::contract };
                match contract(&figures) {
                    Ok(contract) => Some(Contract { dimension: Dimension::Space, ..contract }),
                    Err(fault) => self.error(node, None, fault),
                }
            }
            Kind::Paint => children[0],
            Kind::Warp | Kind::Twist | Kind::Displace if children[0]?.dimension == Dimension::Plane => {
                self.no_body(node)
            }
            Kind::Formula => {
                self.primitives += 1;
                Some(formula::contract(node, &args))
            }
            Kind::Warp => Some(warp::contract(node, &args, children[0]?)),
            Kind::Twist => match twist::contract(node, children[0]?) {
                Ok(contract) => Some(contract),
                Err(fault) => self.error(node, None, fault),
            },
            Kind::Displace => {
                let child = children[0]?;
                if !child.signed {
                    let message = "a sheet has no sides to be displaced to".to_owned();
                    let hint = Some("give it a thickness with `offset`, or displace what it is made of".into());
                    self.report(node, Severity::Error, None, message, hint);
                    return None;
                }
                Some(displace::contract(node, child))
            }
        }
    }

    fn formulas_are_sound(&mut self, node: &Node) -> bool {
        let mut sound = true;
        for (index, param) in node.shape.formulas().iter().enumerate() {
            match node.formulas.get(index) {
                Some(Ok(_)) => continue,
                Some(Err(fault)) => {
                    self.report(node, Severity::Error, None, fault.to_string(), fault.hint.clone());
                }
                None => {
                    self.error(node, None, format!("`{}` needs `{}`, a formula", node.shape.about.name, param.name));
                }
            }
            sound = false;
        }
        sound
    }

    fn arguments_are_sound(&mut self, node: &Node) -> bool {
        let about = &node.shape.about;
        let mut start = 0;
        let mut sound = true;
        for (index, param) in about.params.iter().enumerate() {
            let width = param.kind.width();
            let own = param.kind.length(node.args.get(start..).unwrap_or_default());
            let end = start.saturating_add(own);
            let is_there = end <= node.args.len() && end > start && (end - start).is_multiple_of(width);
            let fault = if is_there {
                let numbers: Vec<f64> = node.args[start..end].iter().map(|value| value.number()).collect();
                param.kind.fault(&numbers).map(|fault| format!("`{}` of `{}` {fault}", param.name, about.name))
            } else {
                Some(format!("`{}` needs `{}`", about.name, param.name))
            };
            if let Some(fault) = fault {
                self.error(node, Some(index), fault);
                sound = false;
            }
            start = end;
        }
        if start < node.args.len() {
            self.error(node, None, format!("`{}` has too many arguments", about.name));
            sound = false;
        }
        sound
    }
}

/// The box that holds the shape of a sound field.
pub fn extent(field: &Field) -> Extent {
    extent_at(field, 0.0)
}

/// The box that holds all points where a sound field is at most `level`, which is not negative.
pub(crate) fn extent_at(field: &Field, level: f64) -> Extent {
    let (mut min, mut max) = (DVec3::ZERO, DVec3::ZERO);
    for axis in 0..3 {
        let mut direction = DVec3::ZERO;
        direction[axis] = 1.0;
        max[axis] = support(field, direction, level);
        min[axis] = -support(field, -direction, level);
    }
    if (0..3).any(|axis| max[axis] == f64::NEG_INFINITY || min[axis] > max[axis]) {
        Extent::Empty
    } else if min.is_finite() && max.is_finite() {
        Extent::Finite(Aabb { min, max })
    } else {
        Extent::Unbounded
    }
}

/// An upper bound of `direction . p` over all points where the field is at most `level`.
pub(crate) fn support(field: &Field, direction: DVec3, level: f64) -> f64 {
    let node = field.node();
    let args = node.numbers();
    match &node.shape.kind {
        Kind::Primitive(table) => {
            let direction = match node.axis() {
                Some(axis) => axis_map(axis).transpose() * direction,
                None => direction,
            };
            (table.support)(&args, direction, level)
        }
        Kind::Combine(table) => {
            let level = (table.level)(&args, level, node.children.len());
            let supports = node.children.iter().map(|child| support(child, direction, level));
            match table.hull {
                Hull::Both => supports.fold(f64::NEG_INFINITY, f64::max),
                Hull::Common => supports.fold(f64::INFINITY, f64::min),
                Hull::First => supports.take(1).fold(f64::INFINITY, f64::min),
            }
        }
        Kind::Place(table) => {
            let map = (table.map)(&args);
            let within = map.matrix3.transpose() * direction;
            support(&node.children[0], within, level / (table.factor)(&args)) + direction.dot(map.translation)
        }
        Kind::Copies(table) => {
            let of_copy = |index: usize| {
                let map = table.map(&args, index);
                support(&node.children[0], map.matrix3.transpose() * direction, level) + direction.dot(map.translation)
            };
            (0..(table.count)(&args)).map(of_copy).fold(f64::NEG_INFINITY, f64::max)
        }
        Kind::Map(table) => {
            (table.support)(&args, direction, &|direction| support(&node.children[0], direction, level))
        }
        Kind::Product(table) => {
            let figure = |direction: DVec3| support(&node.children[0], direction, level);
            let within = |direction: DVec3| table.support(&args, direction, level, &figure);
            match &table.frame {
                Some(frame) => (frame.support)(&args, direction, &within),
                None => within(direction),
            }
        }
        Kind::Endless { fold, .. } => {
            // Farther out than copies reach, values may come from their boxes.
            let child = |direction: DVec3, level: f64| support(&node.children[0], direction, level);
            let reach =
                |direction: DVec3| child(direction, level).max(child(direction, 0.0) + level * direction.length());
            (fold.support)(&args, direction, &reach)
        }
        Kind::Loft => loft::support(node, direction, level),
        Kind::PerimeterSweep => perimeter_sweep::support(node, direction, level),
        Kind::Modify(table) => match (table.level)(&args, level) {
            Some(level) => support(&node.children[0], direction, level),
            None => f64::INFINITY,
        },
        Kind::Paint => support(&node.children[0], direction, level),
        Kind::Formula => formula::Parts::of(&args).region.support(direction, level),
        Kind::Warp => {
            let region = formula::Region::of(&args).support(direction, level);
            region.min(support(&node.children[0], direction, level) + warp::reach(node, direction))
        }
        Kind::Twist => twist::support(node, direction, level),
        Kind::Displace => support(&node.children[0], direction, level + displace::depth(node)),
    }
}

/// Whether a map takes the plane of x and y to itself.
fn keeps_plane(map: &DAffine3) -> bool {
    // Turns by multiples of a right angle leave rounding errors.
    const NOTHING: f64 = 1e-12;
    let m = map.matrix3;
    [m.x_axis.z, m.y_axis.z, map.translation.z]
        .into_iter()
        .all(|leak| leak.abs() <= NOTHING * m.z_axis.z.abs().max(1.0))
        && m.z_axis.x.abs().max(m.z_axis.y.abs()) <= NOTHING
}

/// The rotation that takes a shape along z to one along `axis`, a cyclic exchange of axes.
pub(crate) fn axis_map(axis: usize) -> DMat3 {
    match axis {
        0 => DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X),
        1 => DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
        _ => DMat3::IDENTITY,
    }
}
