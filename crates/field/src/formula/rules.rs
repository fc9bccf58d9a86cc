//! Rules of simplification.
//!
//! A rule looks at an operation and its operands' terms and gives something cheaper or, in intervals, tighter instead. The rules
//! keep three promises. They change values by no more than rounding any of their parts does. They leave the set alone where there
//! is a value, isolated points excepted: `sqrt(x) - sqrt(x)` is not 0. And a term that no rule applied to is made again by the
//! same call, so that a printed formula is read back as it was.

use super::builder::Builder;
use super::{Binary, Term, TermId, Unary};
use crate::scalar::Scalar;

/// How many terms of a sum or product are searched for one to join another with.
const LONGEST_SEARCH: u32 = 16;

/// A factor, if it may replace others.
fn factor(number: f64) -> Option<f64> {
    (number.is_finite() && number != 0.0).then_some(number)
}

impl Builder {
    /// A function of one term.
    pub(super) fn unary(&mut self, op: Unary, a: TermId) -> TermId {
        if let Some(number) = self.number(a)
            && let Some(result) = self.folded(op.apply(number))
        {
            return result;
        }
        match (op, self.term(a)) {
            (Unary::Neg, _) => self.negative(a),
            (Unary::Abs, _) if self.is_nonnegative(a) => a,
            (Unary::Square | Unary::Abs | Unary::Cos, Term::Unary(Unary::Neg | Unary::Abs, b)) => self.unary(op, b),
            (Unary::Square, Term::Unary(Unary::Square, b)) => self.power(b, 4),
            (Unary::Square, Term::Unary(Unary::Sqrt, b)) if self.is_nonnegative(b) => b,
            (Unary::Square, Term::Power(b, n)) if n.checked_mul(2).is_some() => self.power(b, 2 * n),
            (Unary::Sqrt, Term::Unary(Unary::Square, b)) => self.unary(Unary::Abs, b),
            (Unary::Sqrt, Term::Power(b, n)) if n % 2 == 0 => {
                let root = self.power(b, n / 2);
                self.unary(Unary::Abs, root)
            }
            (Unary::Floor, Term::Unary(Unary::Floor, _)) => a,
            (Unary::Ln, Term::Unary(Unary::Exp, b)) => b,
            (Unary::Sin | Unary::Tan | Unary::Asin | Unary::Atan, Term::Unary(Unary::Neg, b)) => {
                let value = self.unary(op, b);
                self.negative(value)
            }
            _ => self.push(Term::Unary(op, a)),
        }
    }

    fn negative(&mut self, a: TermId) -> TermId {
        match self.term(a) {
            Term::Literal(number) => self.literal(-number),
            Term::Unary(Unary::Neg, b) => b,
            Term::Binary(Binary::Sub, p, q) => self.difference(q, p),
            Term::Binary(Binary::Add, p, q) if let Some(c) = self.number(q) => {
                let c = self.literal(-c);
                self.difference(c, p)
            }
            Term::Binary(Binary::Mul, p, q) if let Some(c) = self.number(q) => self.scaled(p, -c),
            Term::Binary(Binary::Div, p, q) if let Some(c) = self.number(p) => {
                let c = self.literal(-c);
                self.quotient(c, q)
            }
            _ => self.push(Term::Unary(Unary::Neg, a)),
        }
    }

    /// A function of two terms.
    pub(super) fn binary(&mut self, op: Binary, a: TermId, b: TermId) -> TermId {
        if let (Some(left), Some(right)) = (self.number(a), self.number(b))
            && let Some(result) = self.folded(op.apply(left, right))
        {
            return result;
        }
        // The literal of an operation that commutes is the right one.
        let swap = op.is_commutative() && self.number(a).is_some();
        let (a, b) = if swap { (b, a) } else { (a, b) };
        match op {
            Binary::Add => self.sum(a, b),
            Binary::Sub => self.difference(a, b),
            Binary::Mul => self.product(a, b),
            Binary::Div => self.quotient(a, b),
            Binary::Min | Binary::Max => self.extreme(op, a, b),
            Binary::Pow => self.any_power(a, b),
            Binary::Less if a == b && self.is_total(a) => self.literal(0.0),
            Binary::Less | Binary::Atan2 => self.push(Term::Binary(op, a, b)),
        }
    }

    fn sum(&mut self, a: TermId, b: TermId) -> TermId {
        if self.number(b) == Some(0.0) {
            return a;
        }
        match (self.term(a), self.term(b)) {
            (Term::Unary(Unary::Neg, p), Term::Unary(Unary::Neg, q)) => {
                let sum = self.sum(p, q);
                return self.negative(sum);
            }
            (Term::Unary(Unary::Neg, p), _) => return self.difference(b, p),
            (_, Term::Unary(Unary::Neg, q)) => return self.difference(a, q),
            _ => {}
        }
        // Negative factors are written as differences; of two, one stays.
        if let Some(opposite) = self.opposite(b) {
            return self.difference(a, opposite);
        }
        if let Some(opposite) = self.opposite(a) {
            return self.difference(b, opposite);
        }
        if let Some(joined) = self.joined_sum(a, b, 1.0).or_else(|| self.joined_sum(b, a, 1.0)) {
            return joined;
        }
        self.push(Term::Binary(Binary::Add, a, b))
    }

    fn difference(&mut self, a: TermId, b: TermId) -> TermId {
        if a == b && self.is_total(a) {
            return self.literal(0.0);
        }
        match (self.number(a), self.number(b)) {
            (Some(left), Some(right)) => {
                return match self.folded(left - right) {
                    Some(result) => result,
                    None => self.push(Term::Binary(Binary::Sub, a, b)),
                };
            }
            (_, Some(right)) => {
                let opposite = self.literal(-right);
                return self.sum(a, opposite);
            }
            (Some(0.0), _) => return self.negative(b),
            _ => {}
        }
        match (self.term(a), self.term(b)) {
            (_, Term::Unary(Unary::Neg, q)) => return self.binary(Binary::Add, a, q),
            (Term::Unary(Unary::Neg, p), _) => {
                let sum = self.sum(p, b);
                return self.negative(sum);
            }
            _ => {}
        }
        if let Some(opposite) = self.opposite(b) {
            return self.binary(Binary::Add, a, opposite);
        }
        if let Some(joined) = self.joined_sum(a, b, -1.0) {
            return joined;
        }
        if let Some(joined) = self.joined_sum(b, a, -1.0) {
            return self.negative(joined);
        }
        self.push(Term::Binary(Binary::Sub, a, b))
    }

    /// `-a`, where `a` has a factor below 0.
    fn opposite(&mut self, a: TermId) -> Option<TermId> {
        match self.term(a) {
            Term::Binary(Binary::Mul, p, q) if let Some(c @ ..0.0) = self.number(q) => Some(self.scaled(p, -c)),
            Term::Binary(Binary::Div, p, q) if let Some(c @ ..0.0) = self.number(p) => {
                let c = self.literal(-c);
                Some(self.quotient(c, q))
            }
            _ => None,
        }
    }

    /// A term as a multiple of another; of 1, for a number.
    fn multiple(&self, a: TermId) -> (Option<TermId>, f64) {
        match self.term(a) {
            Term::Literal(number) => (None, number),
            Term::Unary(Unary::Neg, p) => (Some(p), -1.0),
            Term::Binary(Binary::Mul, p, q) if let Some(c) = self.number(q) => (Some(p), c),
            _ => (Some(a), 1.0),
        }
    }

    /// `sum + sign * a`, if `sum` has a term that is a multiple of the same thing as `a`.
    fn joined_sum(&mut self, sum: TermId, a: TermId, sign: f64) -> Option<TermId> {
        let (base, factor) = self.multiple(a);
        self.join_sum(sum, base, sign * factor, &mut { LONGEST_SEARCH })
    }

    fn join_sum(&mut self, sum: TermId, base: Option<TermId>, factor: f64, budget: &mut u32) -> Option<TermId> {
        *budget = budget.checked_sub(1)?;
        match self.term(sum) {
            Term::Binary(Binary::Add, p, q) => {
                if let Some(joined) = self.join_sum(p, base, factor, budget) {
                    return Some(self.binary(Binary::Add, joined, q));
                }
                let joined = self.join_sum(q, base, factor, budget)?;
                Some(self.binary(Binary::Add, p, joined))
            }
            Term::Binary(Binary::Sub, p, q) => {
                if let Some(joined) = self.join_sum(p, base, factor, budget) {
                    return Some(self.binary(Binary::Sub, joined, q));
                }
                let joined = self.join_sum(q, base, -factor, budget)?;
                Some(self.binary(Binary::Sub, p, joined))
            }
            _ => {
                let (own_base, own_factor) = self.multiple(sum);
                let total = own_factor + factor;
                if own_base != base || !total.is_finite() {
                    return None;
                }
                match base {
                    None => Some(self.literal(total)),
                    Some(base) if total != 0.0 => Some(self.scaled(base, total)),
                    Some(base) => self.is_total(base).then(|| self.literal(0.0)),
                }
            }
        }
    }

    /// `factor * a`, where `factor` is not 0.
    fn scaled(&mut self, a: TermId, factor: f64) -> TermId {
        let factor = self.literal(factor);
        self.binary(Binary::Mul, a, factor)
    }

    fn product(&mut self, a: TermId, b: TermId) -> TermId {
        if let Some(factor) = self.number(b) {
            return self.multiplied(a, factor);
        }
        match (self.term(a), self.term(b)) {
            (Term::Unary(Unary::Neg, p), _) => {
                let product = self.product(p, b);
                return self.negative(product);
            }
            (_, Term::Unary(Unary::Neg, q)) => {
                let product = self.product(a, q);
                return self.negative(product);
            }
            (_, Term::Binary(Binary::Div, one, q)) if self.number(one) == Some(1.0) => return self.quotient(a, q),
            (Term::Binary(Binary::Div, one, q), _) if self.number(one) == Some(1.0) => return self.quotient(b, q),
            _ => {}
        }
        if a == b {
            return self.unary(Unary::Square, a);
        }
        if let Some(joined) = self.joined_product(a, b).or_else(|| self.joined_product(b, a)) {
            return joined;
        }
        self.push(Term::Binary(Binary::Mul, a, b))
    }

    /// `by * a`, where `a` is no number.
    fn multiplied(&mut self, a: TermId, by: f64) -> TermId {
        match (self.term(a), by) {
            (_, 0.0) if self.is_total(a) => return self.literal(0.0),
            (_, 1.0) => return a,
            (_, -1.0) => return self.negative(a),
            (Term::Unary(Unary::Neg, p), _) => return self.multiplied(p, -by),
            (Term::Binary(Binary::Mul, p, q), _)
                if let Some(own) = self.number(q)
                    && let Some(total) = factor(own * by) =>
            {
                return self.scaled(p, total);
            }
            (Term::Binary(Binary::Div, p, q), _)
                if let Some(own) = self.number(q)
                    && let Some(total) = factor(by / own) =>
            {
                return self.scaled(p, total);
            }
            (Term::Binary(Binary::Div, p, q), _)
                if let Some(own) = self.number(p)
                    && let Some(total) = factor(own * by) =>
            {
                let numerator = self.literal(total);
                return self.quotient(numerator, q);
            }
            _ => {}
        }
        let factor = self.literal(by);
        self.push(Term::Binary(Binary::Mul, a, factor))
    }

    /// A term as a positive power of another.
    fn powers(&self, a: TermId) -> (TermId, i32) {
        match self.term(a) {
            Term::Unary(Unary::Square, b) => (b, 2),
            Term::Power(b, n @ 1..) => (b, n),
            _ => (a, 1),
        }
    }

    /// `product * a`, if `product` has a factor that is a power of the same thing as `a`.
    fn joined_product(&mut self, product: TermId, a: TermId) -> Option<TermId> {
        let (base, exponent) = self.powers(a);
        self.join_product(product, base, exponent, &mut { LONGEST_SEARCH })
    }

    fn join_product(&mut self, product: TermId, base: TermId, exponent: i32, budget: &mut u32) -> Option<TermId> {
        *budget = budget.checked_sub(1)?;
        if let Term::Binary(Binary::Mul, p, q) = self.term(product) {
            if let Some(joined) = self.join_product(p, base, exponent, budget) {
                return Some(self.binary(Binary::Mul, joined, q));
            }
            let joined = self.join_product(q, base, exponent, budget)?;
            return Some(self.binary(Binary::Mul, p, joined));
        }
        let (own_base, own_exponent) = self.powers(product);
        let total = own_exponent.checked_add(exponent)?;
        (own_base == base).then(|| self.power(base, total))
    }

    fn quotient(&mut self, a: TermId, b: TermId) -> TermId {
        if let (Some(left), Some(right)) = (self.number(a), self.number(b))
            && let Some(result) = self.folded(left / right)
        {
            return result;
        }
        if let Some(divisor) = self.number(b).filter(|&divisor| divisor != 0.0) {
            return self.divided(a, divisor);
        }
        match (self.term(a), self.term(b)) {
            (Term::Unary(Unary::Neg, p), _) => {
                let quotient = self.quotient(p, b);
                self.negative(quotient)
            }
            (_, Term::Unary(Unary::Neg, q)) => {
                let quotient = self.quotient(a, q);
                self.negative(quotient)
            }
            (Term::Binary(Binary::Div, p, q), _) => {
                let divisor = self.binary(Binary::Mul, q, b);
                self.quotient(p, divisor)
            }
            _ => self.push(Term::Binary(Binary::Div, a, b)),
        }
    }

    /// `a / divisor`, where `divisor` is not 0.
    fn divided(&mut self, a: TermId, divisor: f64) -> TermId {
        // The reciprocal of a power of two is exact.
        let is_power_of_two = divisor.to_bits() << 12 == 0 && divisor.is_normal() && (1.0 / divisor).is_normal();
        if is_power_of_two {
            return self.scaled(a, 1.0 / divisor);
        }
        if divisor < 0.0 {
            let quotient = self.divided(a, -divisor);
            return self.negative(quotient);
        }
        match self.term(a) {
            Term::Unary(Unary::Neg, p) => {
                let quotient = self.divided(p, divisor);
                return self.negative(quotient);
            }
            Term::Binary(Binary::Mul, p, q)
                if let Some(own) = self.number(q)
                    && let Some(total) = factor(own / divisor) =>
            {
                return self.scaled(p, total);
            }
            Term::Binary(Binary::Div, p, q)
                if let Some(own) = self.number(q)
                    && let Some(total) = factor(own * divisor) =>
            {
                return self.divided(p, total);
            }
            Term::Binary(Binary::Div, p, q)
                if let Some(own) = self.number(p)
                    && let Some(total) = factor(own / divisor) =>
            {
                let numerator = self.literal(total);
                return self.quotient(numerator, q);
            }
            _ => {}
        }
        let divisor = self.literal(divisor);
        self.push(Term::Binary(Binary::Div, a, divisor))
    }

    /// A minimum or maximum; a number is the right one.
    fn extreme(&mut self, op: Binary, a: TermId, b: TermId) -> TermId {
        let dual = if op == Binary::Min { Binary::Max } else { Binary::Min };
        if a == b {
            return a;
        }
        if let Some(limit) = self.number(b) {
            if limit <= 0.0 && self.is_nonnegative(a) {
                match op {
                    Binary::Max => return a,
                    _ if self.is_total(a) => return b,
                    _ => {}
                }
            }
            if let Term::Binary(own_op, p, q) = self.term(a)
                && let Some(own) = self.number(q)
                && own_op == op
            {
                let limit = self.literal(op.apply(own, limit));
                return self.extreme(op, p, limit);
            }
        }
        for (one, other) in [(a, b), (b, a)] {
            match self.term(one) {
                Term::Binary(own_op, p, q) if own_op == op && (p == other || q == other) => return one,
                Term::Binary(own_op, p, q) if own_op == dual && (p == other || q == other) && self.is_total(one) => {
                    return other;
                }
                _ => {}
            }
        }
        if let (Term::Unary(Unary::Neg, p), Term::Unary(Unary::Neg, q)) = (self.term(a), self.term(b)) {
            let extreme = self.extreme(dual, p, q);
            return self.unary(Unary::Neg, extreme);
        }
        self.push(Term::Binary(op, a, b))
    }

    /// `a^b`, where not both are numbers, or the result is not finite.
    fn any_power(&mut self, a: TermId, b: TermId) -> TermId {
        if let Some(exponent) = self.number(b) {
            let whole = exponent as i32;
            if f64::from(whole) == exponent {
                return self.power(a, whole);
            }
            if exponent.abs() == 0.5 {
                let root = self.unary(Unary::Sqrt, a);
                return if exponent > 0.0 { root } else { self.power(root, -1) };
            }
        }
        match self.number(a) {
            Some(std::f64::consts::E) => self.unary(Unary::Exp, b),
            Some(1.0) if self.is_total(b) => a,
            _ => self.push(Term::Binary(Binary::Pow, a, b)),
        }
    }

    /// An integer power.
    pub(super) fn power(&mut self, a: TermId, n: i32) -> TermId {
        if let Some(number) = self.number(a)
            && let Some(result) = self.folded(Scalar::powi(number, n))
        {
            return result;
        }
        match (n, self.term(a)) {
            (0, _) => self.literal(1.0),
            (1, _) => a,
            (2, _) => self.unary(Unary::Square, a),
            (-1, _) => {
                let one = self.literal(1.0);
                self.quotient(one, a)
            }
            (_, Term::Unary(Unary::Neg | Unary::Abs, b)) if n % 2 == 0 => self.power(b, n),
            (_, Term::Unary(Unary::Neg, b)) => {
                let power = self.power(b, n);
                self.negative(power)
            }
            (_, Term::Unary(Unary::Square, b)) if let Some(n) = n.checked_mul(2) => self.power(b, n),
            (_, Term::Power(b, m)) if let Some(n) = n.checked_mul(m) => self.power(b, n),
            (_, Term::Unary(Unary::Sqrt, b)) if n % 2 == 0 && self.is_nonnegative(b) => self.power(b, n / 2),
            _ => self.push(Term::Power(a, n)),
        }
    }
}
