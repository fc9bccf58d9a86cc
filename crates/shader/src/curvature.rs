//! How fast the slope of a formula can fall along a line: with that, a value and a slope at a point bound how far the zero ahead
//! is.
//!
//! Along a line with unit direction d, f(t) >= f + (g . d) t - c t^2 / 2, where no second derivative in the region is less than
//! -c (Taylor's theorem). Second derivatives are enclosed by dual numbers over intervals in the cells of a grid, and their least
//! eigenvalue by Gershgorin's circles. A maximum keeps the bound: it is no less than the operand whose slope was taken.

use freikugel_field::expr::{Binary, Graph, Term, Unary};
use freikugel_field::{Dual, Interval, Program, Scalar};

/// Cells along each axis of the region: enclosures of polynomials are narrow enough, and it takes some milliseconds.
const CELLS: usize = 8;

/// More terms than this would take too long.
const MOST_TERMS: usize = 400;

/// A value with first and second derivatives over a box.
type Jet = Dual<Dual<Interval>>;

/// The number c above for the field of a program over a region, or `None` if the field has edges that point inwards, or no
/// bound is found.
pub(crate) fn curvature(program: &Program, region: [Interval; 3]) -> Option<f64> {
    let graph = Graph::new();
    let root = program.expression(&graph).id();
    let formula = Formula { terms: graph.terms(), slots: program.constants() };
    if !graph.loops().is_empty() || formula.terms.len() > MOST_TERMS {
        return None;
    }
    let mut smooth = Vec::new();
    formula.operands(root, &mut smooth)?;
    let is_needed = formula.needed(&smooth)?;
    let side = |axis: usize, cell: usize| {
        let at = |share: usize| region[axis].lo() + region[axis].width() * share as f64 / CELLS as f64;
        Interval::new(at(cell), if cell + 1 == CELLS { region[axis].hi() } else { at(cell + 1) })
    };
    let mut most = 0.0_f64;
    for cell in 0..CELLS.pow(3) {
        let cell = [cell % CELLS, cell / CELLS % CELLS, cell / CELLS.pow(2)];
        let jets = formula.jets([0, 1, 2].map(|axis| side(axis, cell[axis])), &is_needed);
        for &operand in &smooth {
            let fall = fall(&jets[operand as usize]);
            if !fall.is_finite() {
                return None;
            }
            most = most.max(fall);
        }
    }
    Some(most)
}

/// The least eigenvalue of the second derivatives with its sign turned, or 0 if none is negative.
fn fall(jet: &Jet) -> f64 {
    let entry = |row: usize, column: usize| jet.gradient[row].gradient[column];
    let circle = |row: usize| {
        let others: f64 = (0..3).filter(|&other| other != row).map(|other| entry(row, other).abs().hi()).sum();
        others - entry(row, row).lo()
    };
    // The maximum of standard floating-point numbers would pass over what is not a number.
    (0..3).map(circle).fold(0.0, |most, fall| if fall <= most { most } else { fall })
}

struct Formula<'a> {
    terms: Vec<Term>,
    slots: &'a [f64],
}

impl Formula<'_> {
    fn term(&self, id: u32) -> Term {
        self.terms[id as usize]
    }

    /// The operands of maxima at the root that are not convex.
    fn operands(&self, id: u32, found: &mut Vec<u32>) -> Option<()> {
        if self.is_convex(id) {
            return Some(());
        }
        match self.term(id) {
            Term::Binary(Binary::Max, a, b) => {
                self.operands(a, found)?;
                self.operands(b, found)
            }
            _ => {
                found.push(id);
                Some(())
            }
        }
    }

    /// Whether it certainly is a convex function: distances from convex shapes are, though they have no second derivative
    /// everywhere.
    fn is_convex(&self, id: u32) -> bool {
        match self.term(id) {
            Term::Binary(Binary::Add | Binary::Max, a, b) => self.is_convex(a) && self.is_convex(b),
            Term::Binary(Binary::Sub, a, b) => self.is_convex(a) && self.is_affine(b),
            Term::Unary(Unary::Abs, a) => self.is_affine(a),
            Term::Length(a, b, c) => self.is_affine(a) && self.is_affine(b) && c.is_none_or(|c| self.is_affine(c)),
            _ => self.is_affine(id),
        }
    }

    fn is_affine(&self, id: u32) -> bool {
        match self.term(id) {
            Term::Input(_) => true,
            Term::Unary(Unary::Neg, a) => self.is_affine(a),
            Term::Binary(Binary::Add | Binary::Sub, a, b) => self.is_affine(a) && self.is_affine(b),
            Term::Binary(Binary::Mul, a, b) => {
                self.is_constant(a) && self.is_affine(b) || self.is_affine(a) && self.is_constant(b)
            }
            _ => self.is_constant(id),
        }
    }

    fn is_constant(&self, id: u32) -> bool {
        match self.term(id) {
            Term::Slot(_) | Term::Literal(_) => true,
            Term::Unary(Unary::Neg, a) => self.is_constant(a),
            Term::Binary(Binary::Add | Binary::Sub | Binary::Mul, a, b) => self.is_constant(a) && self.is_constant(b),
            _ => false,
        }
    }

    /// Which terms some others depend on; `None` if one of these is not smooth.
    fn needed(&self, roots: &[u32]) -> Option<Vec<bool>> {
        let mut is_needed = vec![false; self.terms.len()];
        let mut pending = roots.to_vec();
        while let Some(id) = pending.pop() {
            if std::mem::replace(&mut is_needed[id as usize], true) {
                continue;
            }
            match self.term(id) {
                Term::Input(_) | Term::Slot(_) | Term::Literal(_) => {}
                Term::Unary(Unary::Neg | Unary::Sqrt | Unary::Sin | Unary::Cos | Unary::Exp | Unary::Ln, a) => {
                    pending.push(a);
                }
                Term::Binary(Binary::Add | Binary::Sub | Binary::Mul | Binary::Div, a, b) => pending.extend([a, b]),
                Term::Length(a, b, c) => pending.extend([Some(a), Some(b), c].into_iter().flatten()),
                _ => return None,
            }
        }
        Some(is_needed)
    }

    /// The values of all terms that are needed over a box; the others are 0.
    fn jets(&self, region: [Interval; 3], is_needed: &[bool]) -> Vec<Jet> {
        let constant = |x: f64| Jet::independent(Dual::independent(Interval::point(x)));
        let mut jets: Vec<Jet> = Vec::with_capacity(self.terms.len());
        for (&term, &is_needed) in self.terms.iter().zip(is_needed) {
            let at = |id: u32| jets[id as usize];
            let jet = match term {
                _ if !is_needed => constant(0.0),
                Term::Input(axis) => Jet::input(Dual::input(region[axis as usize], axis as usize), axis as usize),
                Term::Slot(slot) => constant(self.slots[slot as usize]),
                Term::Literal(bits) => constant(f64::from_bits(bits)),
                Term::Unary(Unary::Neg, a) => -at(a),
                Term::Unary(Unary::Sqrt, a) => at(a).sqrt(),
                Term::Unary(Unary::Sin, a) => at(a).sin(),
                Term::Unary(Unary::Cos, a) => at(a).cos(),
                Term::Unary(Unary::Exp, a) => at(a).exp(),
                Term::Unary(Unary::Ln, a) => at(a).ln(),
                Term::Binary(Binary::Add, a, b) => at(a) + at(b),
                Term::Binary(Binary::Sub, a, b) => at(a) - at(b),
                // Both factors are the same number, which a product of intervals does not know.
                Term::Binary(Binary::Mul, a, b) if a == b => at(a).square(),
                Term::Binary(Binary::Mul, a, b) => at(a) * at(b),
                Term::Binary(Binary::Div, a, b) => at(a) / at(b),
                Term::Length(a, b, None) => Jet::length2(at(a), at(b)),
                Term::Length(a, b, Some(c)) => Jet::length3(at(a), at(b), at(c)),
                _ => unreachable!("what is needed is smooth"),
            };
            jets.push(jet);
        }
        jets
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use freikugel_field::Structure;
    use glam::DVec3;

    /// The program of a shape in scene notation.
    fn program(shape: &str) -> Program {
        let text = format!(r#"{{ "version": 1, "objects": [{{ "shape": {shape} }}] }}"#);
        let scene = freikugel_scene::read(&text).scene.unwrap_or_else(|| panic!("{shape}"));
        Structure::compile(&[scene.objects[0].shape.clone()]).expect("a field").program(DVec3::ZERO)
    }

    const REACH: f64 = 1.5;

    fn region() -> [Interval; 3] {
        [Interval::new(-REACH, REACH); 3]
    }

    #[test]
    fn parabolas_lie_below_the_field_on_every_line() {
        let shapes = [
            r#"{ "formula": "x^2 + y^2 - z^2 - 0.2" }"#,
            r#"{ "formula": "sin(3x)*cos(2y) + sin(y)*cos(3z) + z*x*y" }"#,
            r#"{ "formula": "x^4 - 3x^2*y + exp(z)/(2 + y^2) - 1" }"#,
            r#"{ "formula": { "f": "x*y*z - 0.1 - x^3", "within": { "sphere": 1.2 } } }"#,
        ];
        let mut state = 0x2545_F491_4F6C_DD1D_u64;
        let mut random = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            2.0 * REACH * ((state >> 11) as f64 / (1_u64 << 53) as f64) - REACH
        };
        for shape in shapes {
            let program = program(shape);
            let c = curvature(&program, region()).unwrap_or_else(|| panic!("{shape}"));
            for _ in 0..2000 {
                let mut point = || DVec3::new(random(), random(), random());
                let (a, b) = (point(), point());
                let (value, gradient) = program.gradient(a);
                let t = a.distance(b);
                let below = value + gradient.dot(b - a) - 0.5 * c * t * t;
                let scale = 1e-9 * (1.0 + value.abs() + gradient.length());
                assert!(program.value(b) >= below - scale, "{shape}: {} < {below} from {a} to {b}", program.value(b));
            }
        }
    }

    #[test]
    fn a_bound_is_near_what_is_known() {
        let c = |shape: &str| curvature(&program(shape), region());
        // Convex; a saddle; the negative curvature of a cosine.
        assert!(c(r#"{ "formula": "x^2 + y^2 + z^2 - 1" }"#).expect("smooth") < 1e-9);
        let saddle = c(r#"{ "formula": "x^2 - y^2 + z" }"#).expect("smooth");
        assert!((2.0..2.1).contains(&saddle), "{saddle}");
        let wave = c(r#"{ "formula": "cos(2x) + y" }"#).expect("smooth");
        assert!((4.0..4.5).contains(&wave), "{wave}");
    }

    #[test]
    fn inward_edges_have_none() {
        for formula in ["min(x, y)", "x - abs(y)", "x + floor(y)"] {
            assert_eq!(curvature(&program(&format!(r#"{{ "formula": "{formula}" }}"#)), region()), None, "{formula}");
        }
    }
}
