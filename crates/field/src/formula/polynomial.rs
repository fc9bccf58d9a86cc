//! Formulas that are polynomials, as sums of monomials.

use super::{Binary, Formula, Term, Unary};
use std::collections::BTreeMap;

/// The highest degree, of a monomial in all coordinates together, that is expanded.
pub const HIGHEST_DEGREE: u32 = 12;

/// Formulas with more terms than these are not expanded: it takes time and memory for hundreds of monomials each.
const MOST_TERMS: usize = 2000;

/// `coefficient * x^i * y^j * z^k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Monomial {
    /// The exponents of x, y and z.
    pub exponents: [u8; 3],
    /// The factor before them; not 0.
    pub coefficient: f64,
}

/// A sum of monomials with different exponents.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    monomials: Vec<Monomial>,
}

impl Polynomial {
    /// The monomials, in ascending order of exponents; none for the polynomial 0.
    pub fn monomials(&self) -> &[Monomial] {
        &self.monomials
    }

    /// The highest sum of the exponents of a monomial; 0 for a constant.
    pub fn degree(&self) -> u32 {
        self.monomials.iter().map(|monomial| degree(monomial.exponents)).max().unwrap_or(0)
    }

    /// The value at a point.
    pub fn value(&self, p: [f64; 3]) -> f64 {
        let power = |monomial: &Monomial, axis: usize| p[axis].powi(i32::from(monomial.exponents[axis]));
        let values = self.monomials.iter().map(|m| m.coefficient * power(m, 0) * power(m, 1) * power(m, 2));
        values.sum()
    }
}

/// Coefficients by exponents.
type Sum = BTreeMap<[u8; 3], f64>;

fn degree(exponents: [u8; 3]) -> u32 {
    exponents.into_iter().map(u32::from).sum()
}

impl Formula {
    /// The formula as a sum of monomials, if it is a polynomial of degree [`HIGHEST_DEGREE`] or less in all its parts.
    ///
    /// Coefficients are computed in `f64`. Where large ones cancel, the sum has a larger error than the formula.
    pub fn polynomial(&self) -> Option<Polynomial> {
        if self.terms().len() > MOST_TERMS {
            return None;
        }
        let mut sums: Vec<Sum> = Vec::with_capacity(self.terms().len());
        for &term in self.terms() {
            let sum = match term {
                Term::Input(axis) => {
                    let mut exponents = [0; 3];
                    exponents[axis] = 1;
                    Sum::from([(exponents, 1.0)])
                }
                Term::Literal(number) => Sum::from([([0; 3], number)]),
                Term::Unary(Unary::Neg, a) => scaled(&sums[a.index()], -1.0),
                Term::Unary(Unary::Square, a) => product(&sums[a.index()], &sums[a.index()])?,
                Term::Power(a, n) => power(&sums[a.index()], u32::try_from(n).ok()?)?,
                Term::Binary(op, a, b) => {
                    let (a, b) = (&sums[a.index()], &sums[b.index()]);
                    match op {
                        Binary::Add => total(a, b, 1.0),
                        Binary::Sub => total(a, b, -1.0),
                        Binary::Mul => product(a, b)?,
                        Binary::Div => quotient(a, b)?,
                        _ => return None,
                    }
                }
                Term::Unary(..) => return None,
            };
            let is_finite = sum.values().all(|coefficient| coefficient.is_finite());
            sums.push(Some(sum).filter(|_| is_finite)?);
        }
        let monomials = sums.pop()?.into_iter().filter(|&(_, coefficient)| coefficient != 0.0);
        let monomials = monomials.map(|(exponents, coefficient)| Monomial { exponents, coefficient }).collect();
        Some(Polynomial { monomials })
    }
}

fn scaled(a: &Sum, factor: f64) -> Sum {
    a.iter().map(|(&exponents, coefficient)| (exponents, coefficient * factor)).collect()
}

fn total(a: &Sum, b: &Sum, sign: f64) -> Sum {
    let mut sum = a.clone();
    for (&exponents, coefficient) in b {
        *sum.entry(exponents).or_default() += sign * coefficient;
    }
    sum.retain(|_, coefficient| *coefficient != 0.0);
    sum
}

fn product(a: &Sum, b: &Sum) -> Option<Sum> {
    let mut sum = Sum::new();
    for (p, u) in a {
        for (q, v) in b {
            if degree(*p) + degree(*q) > HIGHEST_DEGREE {
                return None;
            }
            *sum.entry([p[0] + q[0], p[1] + q[1], p[2] + q[2]]).or_default() += u * v;
        }
    }
    sum.retain(|_, coefficient| *coefficient != 0.0);
    Some(sum)
}

fn power(a: &Sum, n: u32) -> Option<Sum> {
    // Constants to any power were computed when the formula was read.
    if n > HIGHEST_DEGREE {
        return None;
    }
    (1..n).try_fold(a.clone(), |power, _| product(&power, a))
}

/// Only by a constant.
fn quotient(a: &Sum, b: &Sum) -> Option<Sum> {
    let divisor = b.get(&[0; 3]).copied().filter(|&divisor| b.len() == 1 && divisor != 0.0)?;
    Some(a.iter().map(|(&exponents, coefficient)| (exponents, coefficient / divisor)).collect())
}
