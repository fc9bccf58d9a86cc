//! What a shader is asked to compute.

/// The uniform `view` of all shaders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The size of the whole picture in pixels.
    pub size: [f32; 2],
    /// The upper left pixel of the tile.
    pub tile: [f32; 2],
    /// Where in its pixel the sample lies, from 0 to 1, from the upper left corner.
    pub place: [f32; 2],
    /// Seconds since the start.
    pub time: f32,
    /// What is shown.
    pub show: Show,
    /// Columns and rows of the tile; the output has as many entries.
    pub tile_size: [u32; 2],
    /// What the output keeps of what it holds: 0 for the first sample, which then may find anything there.
    pub keep: f32,
    /// The weight of what is added to that.
    pub weight: f32,
}

/// What is shown, or which numbers are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    /// The linear colour, and 1 if the ray ran out of steps, otherwise 0.
    #[default]
    Lit,
    /// Normals as colours.
    Normals,
    /// Steps as colours: black for none, white for 64 and more.
    Steps,
    /// Brighter where nearer.
    Depth,
    /// Objects by colours.
    Objects,
    /// The normal, and the distance along the ray; -1 where it met nothing.
    LayerNormal,
    /// The distance from the eye's plane and the object's place in the scene (-1 where the ray met nothing), the steps, and 1
    /// if they ran out, otherwise 0.
    LayerNumbers,
}

impl Show {
    /// Its number in shaders.
    pub fn code(self) -> i32 {
        match self {
            Self::Lit => 0,
            Self::Normals => 1,
            Self::Steps => 2,
            Self::Depth => 3,
            Self::Objects => 4,
            Self::LayerNormal => 16,
            Self::LayerNumbers => 17,
        }
    }
}

impl View {
    /// How many bytes the uniform has.
    pub const SIZE: usize = 48;

    /// One sample in the middle of each pixel of a whole picture.
    pub fn of(width: u32, height: u32) -> Self {
        Self {
            size: [width as f32, height as f32],
            tile: [0.0; 2],
            place: [0.5; 2],
            time: 0.0,
            show: Show::Lit,
            tile_size: [width, height],
            keep: 0.0,
            weight: 1.0,
        }
    }

    /// The uniform as shaders read it.
    pub fn bytes(&self) -> [u8; Self::SIZE] {
        let [columns, rows] = self.tile_size;
        let words = [
            self.size[0].to_bits(),
            self.size[1].to_bits(),
            self.tile[0].to_bits(),
            self.tile[1].to_bits(),
            self.place[0].to_bits(),
            self.place[1].to_bits(),
            self.time.to_bits(),
            self.show.code() as u32,
            columns,
            rows,
            self.keep.to_bits(),
            self.weight.to_bits(),
        ];
        let mut bytes = [0; Self::SIZE];
        for (to, word) in bytes.chunks_exact_mut(4).zip(words) {
            to.copy_from_slice(&word.to_le_bytes());
        }
        bytes
    }
}
