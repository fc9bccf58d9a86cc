//! Which graphics processor to compute with.
//!
//! The best one is taken unless someone asks for another: a discrete processor before an integrated one before a virtual
//! one before software on the CPU, and Vulkan, Metal or Direct3D before OpenGL. A name, or a part of one in any case, picks
//! among all that the machine offers; it comes from the caller or else from the environment variable `WGPU_ADAPTER_NAME`.
//! `WGPU_BACKEND` restricts the interfaces that are asked, as in all programs that use wgpu.

use std::fmt;
use wgpu::{AdapterInfo, Backend, Backends, DeviceType, Instance, InstanceDescriptor};

/// The environment variable that names the adapter to use.
const NAME_VARIABLE: &str = "WGPU_ADAPTER_NAME";

/// Which graphics processor to use.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// The one whose name the environment variable `WGPU_ADAPTER_NAME` holds a part of, or the best one if that is not set.
    #[default]
    Automatic,
    /// The best one whose name has this part, in any case.
    Named(String),
}

/// A graphics processor, or software that stands in for one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterSummary {
    /// What it calls itself, such as `llvmpipe (LLVM 15.0.6, 256 bits)`.
    pub name: String,
    /// Discrete, integrated, virtual, software or unknown.
    pub kind: DeviceType,
    /// The interface it is reached by.
    pub backend: Backend,
    /// Its driver and the driver's version.
    pub driver: String,
}

/// Why there is no graphics processor to use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AdapterError {
    /// The machine offers none.
    None,
    /// None has such a name.
    NoSuch {
        /// The part of a name asked for.
        wanted: String,
        /// The names of those there are.
        present: Vec<String>,
    },
}

impl AdapterSummary {
    /// Whether the CPU does its work.
    pub fn is_software(&self) -> bool {
        self.kind == DeviceType::Cpu
    }

    pub(crate) fn of(info: &AdapterInfo) -> Self {
        let driver = [info.driver.trim(), info.driver_info.trim()];
        let driver: Vec<&str> = driver.into_iter().filter(|part| !part.is_empty()).collect();
        Self { name: info.name.clone(), kind: info.device_type, backend: info.backend, driver: driver.join(" ") }
    }

    /// How good a choice it is; smaller is better.
    fn rank(&self) -> (u8, u8) {
        let kind = match self.kind {
            DeviceType::DiscreteGpu => 0,
            DeviceType::IntegratedGpu => 1,
            DeviceType::VirtualGpu => 2,
            // OpenGL often does not say what stands behind it.
            DeviceType::Other => 3,
            DeviceType::Cpu => 4,
        };
        let backend = match self.backend {
            Backend::Vulkan | Backend::Metal | Backend::Dx12 => 0,
            Backend::Gl => 1,
            Backend::BrowserWebGpu | Backend::Noop => 2,
        };
        (kind, backend)
    }
}

/// All graphics processors that can be used, the best one first.
pub fn adapters() -> Vec<AdapterSummary> {
    let instance = instance();
    let mut found: Vec<AdapterSummary> =
        enumerate(&instance).iter().map(|adapter| AdapterSummary::of(&adapter.get_info())).collect();
    found.sort_by_key(AdapterSummary::rank);
    found
}

pub(crate) fn instance() -> Instance {
    Instance::new(InstanceDescriptor::new_without_display_handle_from_env())
}

/// The adapter to use, of those that `is_fit` accepts.
pub(crate) fn select(
    instance: &Instance,
    choice: &Choice,
    is_fit: impl Fn(&wgpu::Adapter) -> bool,
) -> Result<wgpu::Adapter, AdapterError> {
    let mut fit = enumerate(instance);
    fit.retain(is_fit);
    let summaries: Vec<AdapterSummary> = fit.iter().map(|adapter| AdapterSummary::of(&adapter.get_info())).collect();
    let from_environment = std::env::var(NAME_VARIABLE).ok().filter(|name| !name.is_empty());
    let wanted = match choice {
        Choice::Named(name) => Some(name.clone()),
        Choice::Automatic => from_environment,
    };
    let index = best(&summaries, wanted.as_deref())?;
    Ok(fit.swap_remove(index))
}

/// OpenGL is asked only where nothing else answers: its loader is slow, and talkative on machines without a screen.
fn enumerate(instance: &Instance) -> Vec<wgpu::Adapter> {
    let adapters = pollster::block_on(instance.enumerate_adapters(Backends::PRIMARY));
    if adapters.is_empty() { pollster::block_on(instance.enumerate_adapters(Backends::GL)) } else { adapters }
}

/// The place of the best adapter whose name has a part.
fn best(adapters: &[AdapterSummary], wanted: Option<&str>) -> Result<usize, AdapterError> {
    let part = wanted.unwrap_or_default().to_lowercase();
    let candidates = adapters.iter().enumerate().filter(|(_, adapter)| adapter.name.to_lowercase().contains(&part));
    match (candidates.min_by_key(|(_, adapter)| adapter.rank()), wanted) {
        (Some((index, _)), _) => Ok(index),
        (None, Some(wanted)) if !adapters.is_empty() => Err(AdapterError::NoSuch {
            wanted: wanted.to_owned(),
            present: adapters.iter().map(|adapter| adapter.name.clone()).collect(),
        }),
        (None, _) => Err(AdapterError::None),
    }
}

/// One line: name, kind, interface, driver.
impl fmt::Display for AdapterSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.kind {
            DeviceType::DiscreteGpu => "discrete",
            DeviceType::IntegratedGpu => "integrated",
            DeviceType::VirtualGpu => "virtual",
            DeviceType::Cpu => "software",
            DeviceType::Other => "unknown kind",
        };
        let backend = match self.backend {
            Backend::Vulkan => "Vulkan",
            Backend::Metal => "Metal",
            Backend::Dx12 => "Direct3D 12",
            Backend::Gl => "OpenGL",
            Backend::BrowserWebGpu => "WebGPU",
            Backend::Noop => "none",
        };
        write!(f, "{} ({kind}, {backend}", self.name)?;
        if !self.driver.is_empty() {
            write!(f, ", {}", self.driver)?;
        }
        f.write_str(")")
    }
}

impl fmt::Display for AdapterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str(
                "this machine offers no graphics processor: install its driver, or for software that stands in for one, \
                 the package mesa-vulkan-drivers (Debian, Ubuntu, Fedora) or vulkan-swrast (Arch)",
            ),
            Self::NoSuch { wanted, present } => {
                write!(f, "no graphics processor here has {wanted:?} in its name; there are: {}", present.join("; "))
            }
        }
    }
}

impl std::error::Error for AdapterError {}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapter(name: &str, kind: DeviceType, backend: Backend) -> AdapterSummary {
        AdapterSummary { name: name.into(), kind, backend, driver: String::new() }
    }

    fn machine() -> Vec<AdapterSummary> {
        vec![
            adapter("llvmpipe (LLVM 15)", DeviceType::Cpu, Backend::Vulkan),
            adapter("Radeon Pro", DeviceType::DiscreteGpu, Backend::Gl),
            adapter("Radeon Pro", DeviceType::DiscreteGpu, Backend::Vulkan),
            adapter("UHD Graphics", DeviceType::IntegratedGpu, Backend::Vulkan),
        ]
    }

    #[test]
    fn the_fastest_kind_on_the_best_interface_is_taken() {
        let mut machine = machine();
        assert_eq!(best(&machine, None), Ok(2));
        machine.remove(2);
        assert_eq!(best(&machine, None), Ok(1), "a discrete one by OpenGL before an integrated one");
        machine.remove(1);
        assert_eq!(best(&machine, None), Ok(1));
        machine.remove(1);
        assert_eq!(best(&machine, None), Ok(0), "software where there is nothing else");
        assert_eq!(best(&[], None), Err(AdapterError::None));
    }

    #[test]
    fn a_part_of_the_name_picks_one() {
        let machine = machine();
        assert_eq!(best(&machine, Some("LLVM")), Ok(0));
        assert_eq!(best(&machine, Some("radeon")), Ok(2));
        let error = best(&machine, Some("arc")).expect_err("there is none").to_string();
        assert!(error.contains("\"arc\"") && error.contains("UHD Graphics"), "{error}");
        assert_eq!(best(&[], Some("arc")), Err(AdapterError::None));
    }
}
