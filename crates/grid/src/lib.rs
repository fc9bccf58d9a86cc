//! Sampled distance fields.
//!
//! [`Bricks`] hold a field as voxels near its surface, and as coarse distances elsewhere. They are sampled from any [`Source`]
//! of values at many points at once, and know nothing of what these come from.
//!
//! ```
//! use freikugel_grid::{Block, Bricks, Lattice, Points, Source};
//! use glam::Vec3;
//!
//! struct Ball;
//! impl Source for Ball {
//!     fn values(&mut self, _: &Block, points: &Points, values: &mut [f32]) {
//!         values.iter_mut().zip(points.iter()).for_each(|(value, p)| *value = p.length() - 1.0);
//!     }
//!     fn labels(&mut self, _: &Block, _: &Points, labels: &mut [u32]) {
//!         labels.fill(7);
//!     }
//! }
//!
//! let lattice = Lattice::around(Vec3::splat(-1.0), Vec3::splat(1.0), 50)?;
//! let bricks = Bricks::sample(lattice, &mut Ball)?;
//! let p = Vec3::new(0.6, 0.7, 0.4);
//! assert!((bricks.value(p) - (p.length() - 1.0)).abs() < 1e-3);
//! assert_eq!(bricks.label(p), Some(7));
//! # Ok::<(), freikugel_grid::GridError>(())
//! ```

#![forbid(unsafe_code)]

mod bricks;
mod lattice;
mod read;

pub use bricks::{Block, Bricks, MARGIN, Points, Source};
pub use lattice::{CELLS, FEWEST_CELLS, GridError, Lattice, MOST_CELLS, SAMPLES};
