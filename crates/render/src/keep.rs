//! The cells of a scene, kept from picture to picture.
//!
//! A hierarchy of cells is relative to an origin of its own, the middle of the scene, so that it serves all cameras. What a
//! cell holds does not depend on who asked for it first, so that pictures are the same with kept cells and with new ones.

use freikugel_field::{Aabb, Cells, Structure};
use glam::DVec3;
use std::sync::{Arc, Mutex, PoisonError};

/// The bytes that cells may take before some are taken back: many pictures of all but the largest scenes. A single picture
/// may take more; it gets what it needs.
const MOST: usize = 512 << 20;

/// Where cells lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Site {
    /// What they are relative to.
    pub(crate) origin: DVec3,
    /// How far from there the origins of pictures may lie.
    pub(crate) reach: f64,
    /// What they fill.
    pub(crate) region: Aabb,
}

/// The cells used last.
#[derive(Default)]
pub(crate) struct Keep(Mutex<Option<(Site, Arc<Cells>)>>);

impl Keep {
    /// The cells of a structure at a site: those kept, if they lie there.
    pub(crate) fn cells(&self, structure: &Structure, site: Site) -> Arc<Cells> {
        // Nobody leaves the place in disorder: what is kept is replaced as a whole.
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((place, cells)) = &mut *kept
            && *place == site
        {
            let is_small = cells.weight() <= MOST;
            // What another picture is using can't be trimmed; it goes when that is done.
            let trimmed = is_small || Arc::get_mut(cells).map(|cells| cells.trim(MOST)).is_some();
            if trimmed {
                cells.turn();
                return Arc::clone(cells);
            }
        }
        let cells = Arc::new(Cells::for_origins(&structure.program(site.origin), site.region, site.reach));
        *kept = Some((site, Arc::clone(&cells)));
        cells
    }
}
