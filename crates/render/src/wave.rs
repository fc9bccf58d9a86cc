//! One interface to all methods of tracing: a wave of starts goes in, ends come out.
//!
//! By default rays travel in packets through cells, in which only that part of the field is evaluated that matters there.
//! The plain methods, which exist for comparison and explanation, evaluate the whole field at each step: sphere tracing is
//! a packet in a single cell, the others have files of their own.

use crate::fixed::{Fixed, Rules};
use crate::march::{End, Fate, Start};
use crate::packet::{Packet, Quest, Space};
use crate::rays::Rays;
use crate::relaxed::Relaxed;
use freikugel_field::{Cell, Encloser, Evaluator, Splitter};

/// How rays get from their starts to their ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Way {
    /// In packets: see [`crate::packet`].
    Packets,
    /// By steps of one length in world units: see [`crate::fixed`].
    Fixed { step: f32, has_sheets: bool },
    /// By sphere tracing with longer steps: see [`crate::relaxed`].
    Relaxed { relaxation: f32 },
}

/// Rays that are traced together.
pub(crate) struct Wave<'f> {
    way: Way,
    packet: Packet<'f>,
    /// What waits to be traced in a plain way.
    starts: Vec<Start>,
    fixed: Fixed,
    relaxed: Relaxed,
}

impl<'f> Wave<'f> {
    pub(crate) fn new(way: Way) -> Self {
        Self {
            way,
            packet: Packet::default(),
            starts: Vec::new(),
            fixed: Fixed::default(),
            relaxed: Relaxed::default(),
        }
    }

    /// Adds a ray.
    pub(crate) fn push(&mut self, start: &Start) {
        match self.way {
            Way::Packets => self.packet.push(start),
            Way::Fixed { .. } | Way::Relaxed { .. } => self.starts.push(*start),
        }
    }

    /// Adds those of some camera rays that march.
    pub(crate) fn push_all(&mut self, rays: &Rays) {
        match self.way {
            Way::Packets => self.packet.push_all(rays),
            Way::Fixed { .. } | Way::Relaxed { .. } => self.starts.extend(rays.marching().map(|ray| rays.start(ray))),
        }
    }

    /// Whether there are no rays.
    pub(crate) fn is_empty(&self) -> bool {
        self.packet.is_empty() && self.starts.is_empty()
    }

    /// Whether a ray may be sent on with a finer tolerance from where it hit something. Fixed steps close in on a zero
    /// whatever the tolerance.
    pub(crate) fn heeds_tolerance(&self) -> bool {
        !matches!(self.way, Way::Fixed { .. })
    }

    /// The cell in which a ray of the last wave met something: [`End::place`].
    pub(crate) fn cell(&self, space: &Space<'f>, place: u32) -> &'f Cell {
        match self.way {
            Way::Packets => self.packet.places[place as usize],
            Way::Fixed { .. } | Way::Relaxed { .. } => space.cells.root(),
        }
    }

    /// Takes all rays as far as they go. Appends how they ended; of those that met something, all that met it in one cell
    /// stand together. Returns how many field values that took. The wave is empty afterwards.
    pub(crate) fn travel<'e>(
        &mut self,
        space: &Space<'f>,
        quest: Quest,
        field: &mut Evaluator<'e>,
        encloser: &mut Encloser<'e>,
        splitter: &mut Splitter,
        ends: &mut Vec<End>,
    ) -> u64 {
        let (whole, pace) = (space.cells.root().part(), space.pace);
        let first = ends.len();
        let evaluations = match self.way {
            Way::Packets => return self.packet.travel(space, quest, field, encloser, splitter, ends),
            // Looking for the least ratio of clearance to distance, no clearance may be jumped over.
            Way::Relaxed { .. } if quest == Quest::Least => {
                self.starts.drain(..).for_each(|start| self.packet.push(&start));
                return self.packet.travel(space, quest, field, encloser, splitter, ends);
            }
            Way::Relaxed { relaxation } => self.relaxed.run(field, whole, pace, relaxation, &self.starts, ends),
            Way::Fixed { step, has_sheets } => {
                // Without a scale there is no clearance: a surface dims all or nothing.
                let is_soft = quest == Quest::Least && whole.is_measured();
                self.fixed.run(field, whole, Rules { pace, step, has_sheets, is_soft }, &self.starts, ends)
            }
        };
        self.starts.clear();
        for end in &mut ends[first..] {
            end.place = if end.fate == Fate::Passed { End::NOWHERE } else { 0 };
        }
        ends[first..].sort_unstable_by_key(|end| (end.place, end.id));
        evaluations
    }
}
