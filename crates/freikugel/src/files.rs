//! From scenes to files of pictures. A file appears complete or not at all.

use freikugel_render::{
    Compression, EncodeError, Options, RenderError, Rendered, Tone, encode_exr, encode_png, render,
};
use freikugel_scene::{Picture, Scene};
use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The kinds of picture files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Eight bits a channel, sRGB, with exposure and overbright pixels taken care of.
    Png,
    /// Linear floating-point colours as computed.
    Exr,
}

impl Format {
    /// The format that a file's suffix names.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            _ => None,
        }
    }

    /// The file's bytes. The compression is that of PNG.
    ///
    /// # Errors
    /// If the picture can't be encoded so.
    pub fn encode(
        self,
        rendered: &Rendered,
        picture: &Picture,
        compression: Compression,
    ) -> Result<Vec<u8>, EncodeError> {
        match self {
            Self::Png => encode_png(&rendered.image, &Tone::of(picture), compression),
            Self::Exr => encode_exr(&rendered.image),
        }
    }
}

/// Why no picture was saved.
#[derive(Debug)]
pub enum SaveError {
    /// The suffix names no format.
    Format(PathBuf),
    /// The picture can't be encoded.
    Encode(EncodeError),
    /// The file can't be written.
    Write(PathBuf, io::Error),
}

impl fmt::Display for SaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format(path) => write!(f, "{}: the suffix must be .png or .exr", path.display()),
            Self::Encode(error) => error.fmt(f),
            Self::Write(path, error) => write!(f, "can't write {}: {error}", path.display()),
        }
    }
}

impl std::error::Error for SaveError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Format(_) => None,
            Self::Encode(error) => Some(error),
            Self::Write(_, error) => Some(error),
        }
    }
}

/// Making pictures of scenes.
pub trait Render {
    /// The picture that the scene describes, on all cores.
    ///
    /// # Errors
    /// If the scene has mistakes or the picture would be too large.
    fn render(&self) -> Result<Rendered, RenderError>;

    /// Writes a picture of the scene to a file; the suffix (`.png` or `.exr`) chooses the format.
    ///
    /// # Errors
    /// If there is no such format, or the file can't be written. A file that was there before is then still there.
    fn save(&self, rendered: &Rendered, path: impl AsRef<Path>) -> Result<(), SaveError>;
}

impl Render for Scene {
    fn render(&self) -> Result<Rendered, RenderError> {
        render(self, &Options::of(self), &())
    }

    fn save(&self, rendered: &Rendered, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        let format = Format::of(path).ok_or_else(|| SaveError::Format(path.to_owned()))?;
        let bytes = format.encode(rendered, &self.picture, Compression::Quick).map_err(SaveError::Encode)?;
        let write = || Output::open(path)?.write(&bytes);
        write().map_err(|error| SaveError::Write(path.to_owned(), error))
    }
}

/// A file that will be written at once, when its contents are known.
///
/// Opening it finds out whether it can be written, long before there is anything to write. The contents go to a file
/// beside it, which then takes its name. What is not a regular file (a device, a pipe) is written to directly.
#[derive(Debug)]
pub struct Output(Target);

#[derive(Debug)]
enum Target {
    Beside(NamedTempFile, PathBuf),
    Device(std::fs::File),
}

impl Output {
    /// Prepares to write to `path`.
    ///
    /// # Errors
    /// If it is a folder, or can't be written.
    pub fn open(path: &Path) -> io::Result<Self> {
        // A link stays a link; what it leads to is replaced.
        let path = if path.exists() { path.canonicalize()? } else { path.to_owned() };
        match std::fs::metadata(&path) {
            Ok(known) if known.is_dir() => return Err(io::Error::other("it is a folder")),
            Ok(known) if known.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
            Ok(known) if !known.is_file() => {
                let device = std::fs::OpenOptions::new().write(true).open(&path)?;
                return Ok(Self(Target::Device(device)));
            }
            _ => {}
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if path.file_name().is_none() || !folder.is_dir() {
            return Err(io::Error::new(io::ErrorKind::NotFound, format!("there is no folder {}", folder.display())));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".freikugel-").suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file: what the user's mask leaves.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        // The reason is of interest, not the name of the file beside it.
        let file = builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))?;
        Ok(Self(Target::Beside(file, path)))
    }

    /// The file beside it that must not stay if the program ends early.
    pub fn unfinished(&self) -> Option<&Path> {
        match &self.0 {
            Target::Beside(file, _) => Some(file.path()),
            Target::Device(_) => None,
        }
    }

    /// Writes the contents.
    ///
    /// # Errors
    /// If they can't be written; nothing has then changed.
    pub fn write(self, contents: &[u8]) -> io::Result<()> {
        match self.0 {
            Target::Beside(mut file, path) => {
                file.write_all(contents)?;
                file.as_file().sync_all()?;
                file.persist(path).map_err(|failed| failed.error)?;
                Ok(())
            }
            Target::Device(mut device) => device.write_all(contents),
        }
    }
}
