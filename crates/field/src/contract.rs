//! What is known about a field: the promise that tracers, pruners and meshers take their steps from.

/// How a field's size relates to the true distance, on one side of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Metric {
    /// The Euclidean distance to the surface.
    Exact,
    /// Never larger than that distance.
    Bound,
    /// Right where it is 0 and in its sign; its scale means nothing.
    Implicit,
}

/// How many coordinates of a point a field looks at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// A plane figure: x and y. As long as it is not extruded or revolved, it is no body, and knows no z.
    Plane,
    /// A body: x, y and z.
    #[default]
    Space,
}

/// What is known about a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contract {
    /// Whether it is a plane figure or a body.
    pub dimension: Dimension,
    /// Where the field is positive.
    pub outside: Metric,
    /// Where the field is negative.
    pub inside: Metric,
    /// Whether negative values mean inside. A sheet has no inside; its field is never negative.
    pub signed: bool,
    /// The largest slope: |f(p) - f(q)| <= lipschitz |p - q| for all points `within`; `None` if not known.
    pub lipschitz: Option<f64>,
    /// The box in which `lipschitz` holds; everywhere if `None`. [`analyse`](crate::analyse) only says what holds
    /// everywhere, [`explore`](crate::explore()) looks for more.
    pub within: Option<Aabb>,
}

impl Contract {
    /// An exact signed distance.
    pub const EXACT: Self = Self {
        outside: Metric::Exact,
        inside: Metric::Exact,
        signed: true,
        lipschitz: Some(1.0),
        within: None,
        dimension: Dimension::Space,
    };

    /// A signed bound with slope at most 1.
    pub const BOUND: Self = Self { outside: Metric::Bound, inside: Metric::Bound, ..Self::EXACT };

    /// An exact distance to something without inside.
    pub const SHEET: Self = Self { signed: false, ..Self::EXACT };

    /// At best a bound on either side.
    pub fn at_most_bound(self) -> Self {
        Self { outside: self.outside.max(Metric::Bound), inside: self.inside.max(Metric::Bound), ..self }
    }

    /// The contract of the field with its sign turned, for a field that has one.
    pub fn complement(self) -> Self {
        Self { outside: self.inside, inside: self.outside, ..self }
    }

    /// On each side the weaker of both promises, and signed only if both are.
    pub fn worse_of(self, other: Self) -> Self {
        Self {
            dimension: self.dimension,
            outside: self.outside.max(other.outside),
            inside: self.inside.max(other.inside),
            signed: self.signed && other.signed,
            lipschitz: self.common_lipschitz(other),
            within: common_box(self.within, other.within),
        }
    }

    /// The larger of two Lipschitz constants; unknown if either is.
    pub fn common_lipschitz(self, other: Self) -> Option<f64> {
        Some(self.lipschitz?.max(other.lipschitz?))
    }

    /// Whether a step of the field's size can't cross the surface from outside.
    pub fn is_safe_step(self) -> bool {
        self.outside != Metric::Implicit
    }
}

/// Where both of two constants hold: in what their boxes have in common.
fn common_box(a: Option<Aabb>, b: Option<Aabb>) -> Option<Aabb> {
    match (a, b) {
        (Some(a), Some(b)) => Some(Aabb { min: a.min.max(b.min), max: a.max.min(b.max) }),
        (a, b) => a.or(b),
    }
}

/// The axis-aligned box a shape fills.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// There is no shape.
    Empty,
    /// The shape lies in this box.
    Finite(Aabb),
    /// The shape has no bound, or none is known.
    Unbounded,
}

/// An axis-aligned box with finite corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: glam::DVec3,
    /// The corner with the largest coordinates.
    pub max: glam::DVec3,
}

impl Aabb {
    /// The middle.
    pub fn center(self) -> glam::DVec3 {
        (self.min + self.max) * 0.5
    }

    /// Full edge lengths.
    pub fn size(self) -> glam::DVec3 {
        self.max - self.min
    }

    /// The smallest box that holds both.
    pub fn hull(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }
}
