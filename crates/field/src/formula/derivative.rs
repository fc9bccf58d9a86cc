//! Partial derivatives, by the rules of calculus applied to each term in turn.
//!
//! As in [`Dual`](crate::scalar::Dual) numbers, the derivative of `abs` at 0 is 1, that of `floor` and `less` is 0
//! everywhere, and minima and maxima have the derivative of the operand they take. Other than there, a derivative that is
//! infinite stays so (that of `sqrt` at 0), and may leave none at all where it is multiplied with 0.

use super::builder::Builder;
use super::{Binary, Formula, Term, TermId, Unary};

impl Formula {
    /// The partial derivative by coordinate `axis`: 0, 1 or 2.
    #[must_use]
    pub fn derivative(&self, axis: usize) -> Self {
        let mut builder = Builder::of(self.terms());
        let zero = builder.literal(0.0);
        let mut slopes: Vec<TermId> = Vec::with_capacity(self.terms().len());
        for (index, &term) in self.terms().iter().enumerate() {
            let id = TermId(index as u32);
            let slope = if builder.depends(id, axis) { slope(&mut builder, id, term, &slopes) } else { zero };
            slopes.push(slope);
        }
        Self::build(&builder, slopes[self.result().index()])
    }
}

/// The derivative of `term`, which is `id`, by those of its operands.
fn slope(b: &mut Builder, id: TermId, term: Term, slopes: &[TermId]) -> TermId {
    match term {
        Term::Input(_) => b.literal(1.0),
        Term::Literal(_) => b.literal(0.0),
        Term::Unary(op, a) => {
            let inner = slopes[a.index()];
            unary_slope(b, op, id, a, inner)
        }
        Term::Power(a, n) => {
            let power = b.power(a, n.saturating_sub(1));
            let outer = scaled(b, power, f64::from(n));
            times(b, outer, slopes[a.index()])
        }
        Term::Binary(op, p, q) => {
            let (dp, dq) = (slopes[p.index()], slopes[q.index()]);
            binary_slope(b, op, id, [p, q], [dp, dq])
        }
    }
}

fn unary_slope(b: &mut Builder, op: Unary, id: TermId, a: TermId, inner: TermId) -> TermId {
    if b.number(inner) == Some(0.0) {
        return inner;
    }
    let one = b.literal(1.0);
    match op {
        Unary::Neg => b.unary(Unary::Neg, inner),
        Unary::Floor => b.literal(0.0),
        Unary::Abs => {
            let zero = b.literal(0.0);
            let below = b.binary(Binary::Less, a, zero);
            let twice = scaled(b, below, 2.0);
            let sign = b.binary(Binary::Sub, one, twice);
            b.binary(Binary::Mul, inner, sign)
        }
        Unary::Square => {
            let twice = scaled(b, a, 2.0);
            b.binary(Binary::Mul, twice, inner)
        }
        Unary::Sqrt => {
            let half = scaled(b, inner, 0.5);
            b.binary(Binary::Div, half, id)
        }
        Unary::Sin => {
            let cos = b.unary(Unary::Cos, a);
            b.binary(Binary::Mul, cos, inner)
        }
        Unary::Cos => {
            let sin = b.unary(Unary::Sin, a);
            let product = b.binary(Binary::Mul, sin, inner);
            b.unary(Unary::Neg, product)
        }
        Unary::Tan => {
            let square = b.unary(Unary::Square, id);
            let outer = b.binary(Binary::Add, square, one);
            b.binary(Binary::Mul, outer, inner)
        }
        Unary::Asin | Unary::Acos => {
            let square = b.unary(Unary::Square, a);
            let rest = b.binary(Binary::Sub, one, square);
            let root = b.unary(Unary::Sqrt, rest);
            let slope = b.binary(Binary::Div, inner, root);
            if op == Unary::Acos { b.unary(Unary::Neg, slope) } else { slope }
        }
        Unary::Atan => {
            let square = b.unary(Unary::Square, a);
            let sum = b.binary(Binary::Add, square, one);
            b.binary(Binary::Div, inner, sum)
        }
        Unary::Exp => b.binary(Binary::Mul, id, inner),
        Unary::Ln => b.binary(Binary::Div, inner, a),
    }
}

fn binary_slope(b: &mut Builder, op: Binary, id: TermId, [p, q]: [TermId; 2], [dp, dq]: [TermId; 2]) -> TermId {
    match op {
        Binary::Add | Binary::Sub => b.binary(op, dp, dq),
        Binary::Mul => {
            let (left, right) = (b.binary(Binary::Mul, dp, q), times(b, p, dq));
            let left = if b.number(dp) == Some(0.0) { dp } else { left };
            b.binary(Binary::Add, left, right)
        }
        Binary::Div => {
            let product = times(b, id, dq);
            let difference = b.binary(Binary::Sub, dp, product);
            b.binary(Binary::Div, difference, q)
        }
        Binary::Min | Binary::Max => {
            let takes_first = if op == Binary::Min { [p, q] } else { [q, p] };
            let takes_first = b.binary(Binary::Less, takes_first[0], takes_first[1]);
            let difference = b.binary(Binary::Sub, dp, dq);
            let part = times(b, difference, takes_first);
            b.binary(Binary::Add, dq, part)
        }
        Binary::Pow => {
            // (p^q)' = q p^(q - 1) p' + p^q ln(p) q'
            let one = b.literal(1.0);
            let less = b.binary(Binary::Sub, q, one);
            let power = b.binary(Binary::Pow, p, less);
            let by_base = b.binary(Binary::Mul, power, q);
            let by_base = times(b, by_base, dp);
            let ln = b.unary(Unary::Ln, p);
            let by_exponent = b.binary(Binary::Mul, id, ln);
            // By the exponent, it counts as 0 where the base is not positive, as a constant one may be.
            let is_positive = b.number(p).is_none_or(|base| base > 0.0);
            let by_exponent = if is_positive { times(b, by_exponent, dq) } else { b.literal(0.0) };
            b.binary(Binary::Add, by_base, by_exponent)
        }
        Binary::Atan2 => {
            let (left, right) = (times(b, q, dp), times(b, p, dq));
            let difference = b.binary(Binary::Sub, left, right);
            let (square_p, square_q) = (b.unary(Unary::Square, p), b.unary(Unary::Square, q));
            let sum = b.binary(Binary::Add, square_p, square_q);
            b.binary(Binary::Div, difference, sum)
        }
        Binary::Less => b.literal(0.0),
    }
}

fn scaled(b: &mut Builder, a: TermId, factor: f64) -> TermId {
    let factor = b.literal(factor);
    b.binary(Binary::Mul, a, factor)
}

/// The product of something and a derivative, which is 0 if the derivative is 0 everywhere.
fn times(b: &mut Builder, a: TermId, slope: TermId) -> TermId {
    if b.number(slope) == Some(0.0) { slope } else { b.binary(Binary::Mul, a, slope) }
}
