//! What a user reads about a function, and its parameters.

use crate::field::{Field, Value};
use crate::vector::spectral_norm;
use glam::{DMat3, DVec3};

/// What a user reads about a function, and what a reader of scenes needs to decode it.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// The name in scene files and in the library.
    pub name: &'static str,
    /// One sentence: what it is.
    pub summary: &'static str,
    /// The parameters, in the order of the library's constructor. Only the last one may be a list; knots may stand before it.
    pub params: &'static [Param],
    /// Names of the same thing in other systems.
    pub elsewhere: &'static [&'static str],
    /// A complete shape in scene notation.
    pub example: &'static str,
}

/// One parameter of a function.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// Its key in scene files.
    pub name: &'static str,
    /// What values it takes.
    pub kind: ParamKind,
    /// Its numbers if the user writes none; `None` for a required parameter.
    pub default: Option<&'static [f64]>,
    /// What it means, with its unit if it has one.
    pub about: &'static str,
}

/// What values a parameter takes. Each kind is stored as a fixed number of `f64`, except lists and knots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParamKind {
    /// Any finite number.
    Number,
    /// A length, not negative.
    Length,
    /// A length above 0.
    Positive,
    /// A factor other than 0.
    Factor,
    /// A whole number, at least the first and at most the second one.
    Count(u32, u32),
    /// Three whole numbers, each at least the first and at most the second one; a single number stands for three equal ones.
    Counts(u32, u32),
    /// An angle: degrees in files, radians inside.
    Angle,
    /// One of several names, stored as its index. Files that were written with numbers may use those instead, where
    /// every name is one.
    Choice(&'static [&'static str]),
    /// Yes or no, stored as 1 or 0.
    Flag,
    /// A point or displacement.
    Vector,
    /// A vector other than 0; its length does not matter.
    Direction,
    /// Three full lengths above 0; a single number stands for three equal ones.
    Size,
    /// Three lengths, not negative.
    Lengths,
    /// Two full lengths above 0; a single number stands for two equal ones.
    Size2,
    /// Three factors other than 0.
    Factors,
    /// The rows of a matrix of three by three numbers that flattens nothing.
    Matrix,
    /// Three angles about x, y and z.
    Angles,
    /// A quaternion x, y, z, w other than 0; its length does not matter.
    Quaternion,
    /// A quaternion by its real part and those along i, j and k.
    Quadruple,
    /// A region of space: stored as 0 for all of it, or 1 and a sphere's radius, or 2 and a box's three full edge lengths;
    /// always four numbers.
    Region,
    /// A list of numbers.
    Numbers,
    /// A list of points of the plane: x, y.
    Points2,
    /// A list of points: x, y, z.
    Points3,
    /// A list of balls: x, y, z, radius. No radius is negative, and one is above 0.
    Balls,
    /// A list of points with a weight above 0 each: x, y, z, weight.
    Weighted,
    /// One or several closed lines of the plane: lists of corners x, y and the angle by which the edge to the next corner turns
    /// to the left, 0 for a straight one; stored with a fourth number, 1 for the last corner of a line and otherwise 0.
    Contours,
    /// Where the pieces of a spline meet: one of [`ParamKind::KNOTS`], or a list of numbers that don't fall. Stored as the index of
    /// the name; or as the number of names and that of the list's entries together, and then these.
    Knots,
    /// A net of points: two rows or more, with two points or more in each, and equally many; stored row by row with a fourth
    /// number, 1 for the last point of a row and otherwise 0.
    Net,
    /// A net of points with a weight above 0 each, which stands before the number that tells the last point of a row.
    WeightedNet,
    /// A text: a list of the numbers of its characters.
    Text,
    /// A list of half-spaces, each with an outward normal and the distance of its plane from the origin: x, y, z, d.
    HalfSpaces,
}

/// A file among what a shape takes, which it is made with, and not kept.
#[derive(Clone, Copy, Debug)]
pub struct FileParam {
    /// Its key in scene files.
    pub name: &'static str,
    /// What it is for, and what the shape is without it.
    pub about: &'static str,
    /// The shape of these arguments, which passed all checks of single parameters, with the contents of the file; or what is wrong
    /// with these.
    pub build: fn(&[f64], &[u8]) -> Result<Field, String>,
}

impl ParamKind {
    /// The names that can stand in place of a list of knots: those at equal distances, and those that make each piece a Bézier
    /// curve of its own.
    pub const KNOTS: &'static [&'static str] = &["even", "pieces"];

    /// How many numbers hold one value (one entry, for a list; at least, for knots).
    pub const fn width(self) -> usize {
        match self {
            Self::Number
            | Self::Length
            | Self::Positive
            | Self::Factor
            | Self::Count(..)
            | Self::Angle
            | Self::Choice(_)
            | Self::Text
            | Self::Numbers
            | Self::Knots
            | Self::Flag => 1,
            Self::Size2 | Self::Points2 => 2,
            Self::Vector
            | Self::Direction
            | Self::Size
            | Self::Lengths
            | Self::Factors
            | Self::Angles
            | Self::Points3
            | Self::Counts(..) => 3,
            Self::Quaternion
            | Self::Quadruple
            | Self::Region
            | Self::HalfSpaces
            | Self::Contours
            | Self::Balls
            | Self::Net
            | Self::Weighted => 4,
            Self::WeightedNet => 5,
            Self::Matrix => 9,
        }
    }

    /// Whether the value is a list of entries.
    pub const fn is_list(self) -> bool {
        matches!(
            self,
            Self::HalfSpaces
                | Self::Points2
                | Self::Points3
                | Self::Balls
                | Self::Weighted
                | Self::Contours
                | Self::Net
                | Self::WeightedNet
                | Self::Numbers
                | Self::Text
        )
    }

    /// How many numbers hold the value that these begin with: for a list all of them.
    pub fn length(self, numbers: &[Value]) -> usize {
        match (self, numbers.first()) {
            (Self::Knots, Some(first)) => (first.number() as usize).saturating_sub(Self::KNOTS.len()).saturating_add(1),
            _ if self.is_list() => numbers.len(),
            _ => self.width(),
        }
    }

    /// Why `value` is not one of this kind, or `None` if it is. The numbers are as stored: angles in radians.
    pub fn fault(self, value: &[f64]) -> Option<String> {
        if value.iter().any(|v| !v.is_finite()) {
            return Some("must be finite".into());
        }
        let length = value.iter().map(|v| v * v).sum::<f64>().sqrt();
        match self {
            Self::Length if value[0] < 0.0 => Some(format!("must not be negative, but is {}", brief(value[0]))),
            Self::Positive if value[0] <= 0.0 => Some(format!("must be above 0, but is {}", brief(value[0]))),
            Self::Factor if value[0] == 0.0 => Some("must not be 0: it would flatten the shape".into()),
            Self::Count(..) if value[0].fract() != 0.0 => {
                Some(format!("must be a whole number, but is {}", brief(value[0])))
            }
            Self::Count(least, most) if !(f64::from(least)..=f64::from(most)).contains(&value[0]) => {
                Some(format!("must be from {least} to {most}, but is {}", brief(value[0])))
            }
            Self::Counts(least, most) if value.iter().any(|&v| Self::Count(least, most).fault(&[v]).is_some()) => {
                Some(format!("must be whole numbers from {least} to {most}"))
            }
            Self::Lengths if value.iter().any(|&v| v < 0.0) => Some("must not be negative in any direction".into()),
            Self::Size | Self::Size2 if value.iter().any(|&v| v <= 0.0) => {
                Some("must be above 0 in every direction".into())
            }
            Self::Factors if value.contains(&0.0) => Some("must not be 0 in any direction".into()),
            Self::Matrix if flattens(of_rows(value)) => Some("must not be singular: it would flatten the shape".into()),
            Self::Direction if length < SHORTEST_DIRECTION => Some("must not be the zero vector".into()),
            Self::Quaternion if length < SHORTEST_DIRECTION => Some("must not be the zero quaternion".into()),
            Self::Region => match *value {
                [kind, radius, ..] if kind == 1.0 && radius <= 0.0 => Some("needs a radius above 0".into()),
                [kind, ref size @ ..] if kind == 2.0 && size.iter().any(|&edge| edge <= 0.0) => {
                    Some("needs a size above 0 in every direction".into())
                }
                [kind, ..] if ![0.0, 1.0, 2.0].contains(&kind) => Some("must be a sphere or a box".into()),
                _ => None,
            },
            Self::HalfSpaces => value.chunks(4).enumerate().find_map(|(i, plane)| {
                (DVec3::new(plane[0], plane[1], plane[2]).length() < SHORTEST_DIRECTION)
                    .then(|| format!("entry {i} has a zero normal"))
            }),
            Self::Balls => match value.chunks(4).position(|ball| ball[3] < 0.0) {
                Some(index) => Some(format!(
                    "must have radii of 0 or more, but entry {} has {}",
                    index + 1,
                    brief(value[4 * index + 3])
                )),
                None if value.chunks(4).all(|ball| ball[3] == 0.0) => Some("must have a radius above 0".into()),
                None => None,
            },
            Self::Weighted => value.chunks(4).position(|point| point[3] <= 0.0).map(|index| {
                format!("must have weights above 0, but entry {} has {}", index + 1, brief(value[4 * index + 3]))
            }),
            Self::Knots if value[0] < 0.0 || value[0].fract() != 0.0 => {
                Some("must be a name or a list of numbers".into())
            }
            Self::Knots => value[1..].windows(2).position(|pair| pair[1] < pair[0]).map(|index| {
                let (entry, low, high) = (index + 2, brief(value[index + 2]), brief(value[index + 1]));
                format!("must not fall, but entry {entry} is {low} after {high}")
            }),
            Self::Net => uneven(value, self.width()),
            Self::WeightedNet => {
                let weight = |point: &[f64]| point[3];
                let is_sound = |point: &[f64]| weight(point) > 0.0;
                match value.chunks(self.width()).enumerate().find(|(_, point)| !is_sound(point)) {
                    Some((index, point)) => {
                        Some(format!("must have weights above 0, but point {} has {}", index + 1, brief(weight(point))))
                    }
                    None => uneven(value, self.width()),
                }
            }
            Self::Contours => value.chunks(4).enumerate().find_map(|(i, corner)| {
                (corner[2].abs() >= std::f64::consts::TAU).then(|| {
                    format!("must have edges that turn by less than 360 degrees, but corner {} has not", i + 1)
                })
            }),
            _ => None,
        }
    }
}

/// What is wrong with the rows of a net, whose points take so many numbers.
fn uneven(net: &[f64], width: usize) -> Option<String> {
    let points: Vec<&[f64]> = net.chunks(width).collect();
    let rows: Vec<usize> = points.split_inclusive(|point| point[width - 1] != 0.0).map(<[_]>::len).collect();
    let columns = rows[0];
    match rows.iter().position(|row| *row != columns) {
        Some(index) => Some(format!(
            "must have as many points in each row, but row {} has {}, and the first one {columns}",
            index + 1,
            rows[index]
        )),
        None if rows.len() < 2 || columns < 2 => {
            Some("must have two rows or more, with two points or more in each".into())
        }
        None => None,
    }
}

/// The matrix with these rows.
pub(crate) fn of_rows(rows: &[f64]) -> DMat3 {
    DMat3::from_cols_slice(&rows[..9]).transpose()
}

/// The smallest factor by which a matrix stretches a vector: its smallest singular value.
pub(crate) fn smallest_stretch(matrix: DMat3) -> f64 {
    1.0 / spectral_norm(matrix.inverse())
}

/// Whether a matrix stretches some direction so much less than another one that it can't be told from one that flattens it.
fn flattens(matrix: DMat3) -> bool {
    // Up to this ratio of stretches the inverse has a few right digits.
    const FLATTEST: f64 = 1e12;
    let ratio = spectral_norm(matrix) / smallest_stretch(matrix);
    matrix.determinant() == 0.0 || ratio.is_nan() || ratio > FLATTEST
}

/// A number for a message: no hundreds of digits.
fn brief(number: f64) -> String {
    if number == 0.0 || (1e-6..1e12).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}

/// Below this length a direction's components lose precision when it is normalised.
pub const SHORTEST_DIRECTION: f64 = 1e-100;

impl Param {
    /// A parameter without default.
    pub const fn required(name: &'static str, kind: ParamKind, about: &'static str) -> Self {
        Self { name, kind, default: None, about }
    }

    /// A parameter with a default.
    pub const fn optional(name: &'static str, kind: ParamKind, default: &'static [f64], about: &'static str) -> Self {
        Self { name, kind, default: Some(default), about }
    }
}

/// The axis an axial shape stands along; always its last parameter. Formulas are written for z.
pub const AXIS: Param =
    Param::optional("axis", ParamKind::Choice(&["x", "y", "z"]), &[2.0], "The axis it stands along.");
