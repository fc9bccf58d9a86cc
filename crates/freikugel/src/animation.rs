//! From pictures to files of moving ones: animated PNG, GIF and WebP; and through `ffmpeg` MP4 and WebM.

use std::cell::RefCell;
use std::fmt;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::rc::Rc;

/// The kinds of files that hold several frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Container {
    /// Animated PNG, without loss.
    Png,
    /// GIF: 256 colours a frame, and frames that last hundredths of a second.
    Gif,
    /// Animated WebP, without loss.
    Webp,
    /// H.264 in MP4, by `ffmpeg`.
    Mp4,
    /// VP9 in WebM, by `ffmpeg`.
    Webm,
}

impl Container {
    /// All kinds with the suffixes of their files.
    pub const ALL: [(Self, &'static str); 5] =
        [(Self::Png, "apng"), (Self::Gif, "gif"), (Self::Webp, "webp"), (Self::Mp4, "mp4"), (Self::Webm, "webm")];

    /// The kind that a file's suffix names.
    pub fn of(path: &Path) -> Option<Self> {
        let suffix = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|&(_, known)| known == suffix).map(|(container, _)| container)
    }

    /// Whether it is made by `ffmpeg`.
    pub fn is_video(self) -> bool {
        matches!(self, Self::Mp4 | Self::Webm)
    }

    /// Why pictures can't be put into such a file, if they can't be.
    pub fn fault(self, size: [u32; 2], rate: u16) -> Option<String> {
        let side = size.into_iter().max().unwrap_or_default();
        match self {
            Self::Gif if rate > GIF_RATE => Some(format!("GIF has {GIF_RATE} frames a second at most, not {rate}")),
            Self::Gif if side > u32::from(u16::MAX) => Some(format!("GIF has {} pixels a side at most", u16::MAX)),
            Self::Webp if side > WEBP_SIDE => Some(format!("WebP has {WEBP_SIDE} pixels a side at most")),
            _ => None,
        }
    }
}

/// Programs take shorter frames of GIF for an oversight, and show them long.
const GIF_RATE: u16 = 50;

/// The longest side of a frame of WebP without loss.
const WEBP_SIDE: u32 = 1 << 14;

/// How hard the colours of a GIF's frame are chosen, from 1 (hardest) to 30.
const GIF_SPEED: i32 = 10;

/// Why frames could not be put into a file.
#[derive(Debug)]
pub enum AnimationError {
    /// The frames can't be encoded.
    Encode(String),
    /// The file can't be written.
    Write(io::Error),
    /// There is no program `ffmpeg`.
    NoFfmpeg,
    /// `ffmpeg` failed; what it said last.
    Ffmpeg(String),
}

impl fmt::Display for AnimationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Encode(fault) => write!(f, "the frames can't be encoded: {fault}"),
            Self::Write(error) => error.fmt(f),
            Self::NoFfmpeg => f.write_str(
                "videos are made by ffmpeg, which is not installed; .gif, .webp and .apng need no other program",
            ),
            Self::Ffmpeg(said) => write!(f, "ffmpeg failed: {said}"),
        }
    }
}

impl std::error::Error for AnimationError {}

fn encode(error: impl fmt::Display) -> AnimationError {
    AnimationError::Encode(error.to_string())
}

/// Frames on their way into a file, all of one size and each as long as the others, repeated without end.
pub struct Animation {
    size: [u32; 2],
    rate: u16,
    /// How many frames it has so far, and how many it is to have.
    count: u32,
    announced: u32,
    target: Target,
}

enum Target {
    Png(Box<png::Writer<Buffer>>, Buffer),
    Gif(gif::Encoder<Vec<u8>>),
    /// The chunks of the frames so far.
    Webp(Vec<u8>),
    Video(Child, ChildStdin),
}

/// Bytes that are still at hand when a writer that owns them is done.
#[derive(Clone, Default)]
struct Buffer(Rc<RefCell<Vec<u8>>>);

impl Write for Buffer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Animation {
    /// An empty animation of `count` frames with `rate` of them a second, for the file at `path`, which only videos write themselves.
    ///
    /// # Errors
    /// If there can't be such a file, or `ffmpeg` is needed and not there.
    pub fn new(
        container: Container,
        path: &Path,
        size: [u32; 2],
        count: u32,
        rate: u16,
    ) -> Result<Self, AnimationError> {
        if let Some(fault) = container.fault(size, rate) {
            return Err(encode(fault));
        }
        let [width, height] = size;
        let target = match container {
            Container::Png => {
                let buffer = Buffer::default();
                let mut encoder = png::Encoder::new(buffer.clone(), width, height);
                encoder.set_color(png::ColorType::Rgb);
                encoder.set_depth(png::BitDepth::Eight);
                encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
                encoder.set_animated(count, 0).map_err(encode)?;
                encoder.set_frame_delay(1, rate).map_err(encode)?;
                Target::Png(Box::new(encoder.write_header().map_err(encode)?), buffer)
            }
            Container::Gif => {
                let side = |side: u32| u16::try_from(side).map_err(encode);
                let mut encoder = gif::Encoder::new(Vec::new(), side(width)?, side(height)?, &[]).map_err(encode)?;
                encoder.set_repeat(gif::Repeat::Infinite).map_err(encode)?;
                Target::Gif(encoder)
            }
            Container::Webp => Target::Webp(Vec::new()),
            Container::Mp4 | Container::Webm => {
                let mut child = ffmpeg(container, path, size, rate).spawn().map_err(|error| match error.kind() {
                    io::ErrorKind::NotFound => AnimationError::NoFfmpeg,
                    _ => AnimationError::Write(error),
                })?;
                let input = child.stdin.take().expect("it was asked for");
                Target::Video(child, input)
            }
        };
        Ok(Self { size, rate, count: 0, announced: count, target })
    }

    /// Adds a frame: sRGB bytes, row by row from the top.
    ///
    /// # Errors
    /// If it can't be encoded.
    ///
    /// # Panics
    /// If it has another size.
    pub fn push(&mut self, pixels: &[u8]) -> Result<(), AnimationError> {
        let [width, height] = self.size;
        assert_eq!(pixels.len(), 3 * width as usize * height as usize, "all frames have the same size");
        let rate = f64::from(self.rate);
        // In units that may not divide a second evenly, frames are longer and shorter by turns, so that no delay adds up.
        let lasts = |units: f64| {
            let at = |frame: u32| (f64::from(frame) * units / rate).round();
            (at(self.count + 1) - at(self.count)) as u32
        };
        match &mut self.target {
            Target::Png(writer, _) => writer.write_image_data(pixels).map_err(encode)?,
            Target::Gif(encoder) => {
                let mut frame = gif::Frame::from_rgb_speed(width as u16, height as u16, pixels, GIF_SPEED);
                frame.delay = lasts(100.0) as u16;
                encoder.write_frame(&frame).map_err(encode)?;
            }
            Target::Webp(chunks) => webp_frame(chunks, self.size, lasts(1000.0), pixels)?,
            Target::Video(_, input) => {
                // Where it has failed, it says why in the end.
                if let Err(error) = input.write_all(pixels)
                    && error.kind() != io::ErrorKind::BrokenPipe
                {
                    return Err(AnimationError::Write(error));
                }
            }
        }
        self.count += 1;
        Ok(())
    }

    /// The contents of the file; `None` for videos, which are in their files then.
    ///
    /// # Errors
    /// If the frames can't be encoded, or are more or fewer than were announced.
    pub fn finish(self) -> Result<Option<Vec<u8>>, AnimationError> {
        if self.count != self.announced {
            return Err(encode(format!("there are {} instead of {}", self.count, self.announced)));
        }
        match self.target {
            Target::Png(writer, buffer) => {
                writer.finish().map_err(encode)?;
                Ok(Some(buffer.0.take()))
            }
            Target::Gif(encoder) => encoder.into_inner().map(Some).map_err(encode),
            Target::Webp(frames) => Ok(Some(webp(self.size, &frames))),
            Target::Video(child, input) => {
                drop(input);
                let output = child.wait_with_output().map_err(AnimationError::Write)?;
                if output.status.success() {
                    return Ok(None);
                }
                let said = String::from_utf8_lossy(&output.stderr);
                let last = said.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it said nothing");
                Err(AnimationError::Ffmpeg(last.trim().to_owned()))
            }
        }
    }
}

/// `ffmpeg` as it makes a video from pixels that it is sent.
fn ffmpeg(container: Container, path: &Path, [width, height]: [u32; 2], rate: u16) -> Command {
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24"]);
    command.args(["-s", &format!("{width}x{height}"), "-r", &rate.to_string(), "-i", "pipe:0"]);
    // Colours are stored for two by two pixels, and as those of high definition, which players assume.
    let filter = "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";
    command.args(["-vf", filter, "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1"]);
    let coding: &[&str] = match container {
        Container::Webm => &["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-f", "webm"],
        _ => &["-c:v", "libx264", "-crf", "16", "-preset", "medium", "-movflags", "+faststart", "-f", "mp4"],
    };
    command.args(coding).arg(path);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// Whether `ffmpeg` can be run.
pub fn has_ffmpeg() -> bool {
    let mut command = Command::new("ffmpeg");
    command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Appends a frame as a chunk `ANMF` (WebP Container Specification, "Animation").
fn webp_frame(
    chunks: &mut Vec<u8>,
    [width, height]: [u32; 2],
    milliseconds: u32,
    pixels: &[u8],
) -> Result<(), AnimationError> {
    let mut still = Vec::new();
    let encoder = image_webp::WebPEncoder::new(&mut still);
    encoder.encode(pixels, width, height, image_webp::ColorType::Rgb8).map_err(encode)?;
    // After the header of the file, there is nothing but the chunk with the picture.
    let picture = &still[RIFF_HEADER..];
    let mut head = Vec::with_capacity(ANMF_HEADER);
    // At the left and top, with its size, and in the place of what was there.
    for number in [0, 0, width - 1, height - 1, milliseconds] {
        head.extend(&number.to_le_bytes()[..3]);
    }
    head.push(0b10);
    chunk(chunks, *b"ANMF", &[&head, picture]);
    Ok(())
}

/// `RIFF`, the size, and `WEBP`.
const RIFF_HEADER: usize = 12;

/// What precedes the picture of a frame.
const ANMF_HEADER: usize = 16;

/// A whole file around the chunks of the frames.
fn webp([width, height]: [u32; 2], frames: &[u8]) -> Vec<u8> {
    let mut body = b"WEBP".to_vec();
    let mut features = vec![0b10, 0, 0, 0];
    for side in [width - 1, height - 1] {
        features.extend(&side.to_le_bytes()[..3]);
    }
    chunk(&mut body, *b"VP8X", &[&features]);
    // Black behind the frames, and no end of repetitions.
    chunk(&mut body, *b"ANIM", &[&[0, 0, 0, 0xFF, 0, 0]]);
    body.extend(frames);
    let mut file = Vec::with_capacity(body.len() + 8);
    chunk(&mut file, *b"RIFF", &[&body]);
    file
}

/// Appends a chunk of RIFF: its name, size, and contents, padded to an even number of bytes.
fn chunk(to: &mut Vec<u8>, name: [u8; 4], parts: &[&[u8]]) {
    let size: usize = parts.iter().map(|part| part.len()).sum();
    to.extend(name);
    to.extend((size as u32).to_le_bytes());
    parts.iter().for_each(|part| to.extend(*part));
    to.extend(std::iter::repeat_n(0, size % 2));
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    const SIZE: [u32; 2] = [7, 5];
    const FRAMES: u32 = 7;
    const RATE: u16 = 30;

    /// A frame of one colour, whose bytes differ from frame to frame.
    fn pixels(frame: u32) -> Vec<u8> {
        [200, 30 * frame as u8, 90].repeat(35)
    }

    fn file(container: Container) -> Vec<u8> {
        let mut animation = Animation::new(container, Path::new(""), SIZE, FRAMES, RATE).expect("an animation");
        (0..FRAMES).for_each(|frame| animation.push(&pixels(frame)).expect("a frame"));
        animation.finish().expect("a file").expect("bytes")
    }

    #[test]
    fn an_animated_png_holds_the_frames() {
        let mut reader = png::Decoder::new(Cursor::new(file(Container::Png))).read_info().expect("a PNG");
        let control = reader.info().animation_control.expect("an animation");
        assert_eq!((control.num_frames, control.num_plays), (FRAMES, 0));
        for frame in 0..FRAMES {
            let mut bytes = vec![0; 7 * 5 * 3];
            reader.next_frame(&mut bytes).expect("pixels");
            assert_eq!(bytes, pixels(frame));
            let delay = reader.info().frame_control.expect("a frame");
            assert_eq!((delay.delay_num, delay.delay_den), (1, RATE));
        }
    }

    #[test]
    fn a_gif_holds_the_frames_and_keeps_time() {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(Cursor::new(file(Container::Gif))).expect("a GIF");
        let mut delays = Vec::new();
        while let Some(frame) = decoder.read_next_frame().expect("a frame") {
            // A frame of one colour keeps it, but for the rounding of the palette.
            let wanted = pixels(delays.len() as u32);
            let off = frame.buffer[..3].iter().zip(&wanted).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(off <= Some(4), "{:?} instead of {:?}", &frame.buffer[..3], &wanted[..3]);
            delays.push(frame.delay);
        }
        assert_eq!(delays, [3, 4, 3, 3, 4, 3, 3], "7 thirtieths of a second in hundredths");
        assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
    }

    #[test]
    fn a_webp_holds_the_frames() {
        let mut decoder = image_webp::WebPDecoder::new(Cursor::new(file(Container::Webp))).expect("a WebP");
        assert!(decoder.is_animated());
        assert_eq!((decoder.dimensions(), decoder.num_frames()), ((7, 5), FRAMES));
        assert_eq!(decoder.loop_count(), image_webp::LoopCount::Forever);
        let mut delays = Vec::new();
        for frame in 0..FRAMES {
            let mut bytes = vec![0; decoder.output_buffer_size().expect("it is small")];
            delays.push(decoder.read_frame(&mut bytes).expect("a frame"));
            let count = bytes.len() / 35;
            let rgb: Vec<u8> = bytes.chunks(count).flat_map(|pixel| &pixel[..3]).copied().collect();
            assert_eq!(rgb, pixels(frame));
        }
        assert_eq!(delays, [33, 34, 33, 33, 34, 33, 33]);
    }

    #[test]
    fn what_a_format_can_not_hold_is_refused() {
        for (container, size, rate) in
            [(Container::Gif, SIZE, 60), (Container::Gif, [70_000, 1], 30), (Container::Webp, [1, 20_000], 30)]
        {
            assert!(Animation::new(container, Path::new(""), size, 1, rate).is_err(), "{container:?}");
        }
        let mut short = Animation::new(Container::Png, Path::new(""), SIZE, 2, RATE).expect("an animation");
        short.push(&pixels(0)).expect("a frame");
        assert!(short.finish().is_err(), "a frame is missing");
    }

    #[test]
    fn suffixes_name_containers() {
        assert_eq!(Container::of(Path::new("a/b.GIF")), Some(Container::Gif));
        assert_eq!(Container::of(Path::new("b.apng")), Some(Container::Png));
        assert_eq!(Container::of(Path::new("b.png")), None, "these are frames of their own");
    }
}
