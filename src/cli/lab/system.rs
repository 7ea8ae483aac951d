//! The options of the integrated system, and the choice of methods.

use super::super::quantity;
use super::super::terminal::complain;
use clap::ValueEnum;
use clap_complete::{ArgValueCandidates, CompletionCandidate};
use sprung::Result;
use sprung::lab::{Force, Method, Spring, State, System};

/// Force law of the spring.
#[derive(Clone, Copy, ValueEnum)]
enum ForceLaw {
    Linear,
    Duffing,
    Pendulum,
}

/// Mass, spring, damper, force and start.
#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct SystemArgs {
    /// Mass in kg, more than 0
    #[arg(long, default_value_t = 1.0, value_name = "KG")]
    mass: f64,
    /// Stiffness of the spring in N/m, 0 or more
    #[arg(long, default_value_t = 50.0, value_name = "N/M")]
    stiffness: f64,
    /// Damping in kg/s, 0 or more
    #[arg(long, default_value_t = 0.0, value_name = "KG/S")]
    damping: f64,
    /// Position at the start, in m
    #[arg(long, default_value_t = 0.5, value_name = "M")]
    x0: f64,
    /// Velocity at the start, in m/s
    #[arg(long, default_value_t = 0.0, value_name = "M/S")]
    v0: f64,
    /// Where the spring pulls to, in m
    #[arg(long, default_value_t = 0.0, value_name = "M")]
    target: f64,
    /// Force law of the spring: a pendulum's force is the stiffness times the sine of the angle
    #[arg(long, default_value = "linear")]
    spring: ForceLaw,
    /// Cubic part of a Duffing spring, in N/m³, 0 or more
    #[arg(long, default_value_t = 0.0, value_name = "N/M³")]
    cubic: f64,
    /// Amplitude of a force that drives the mass, in N
    #[arg(long, default_value_t = 0.0, value_name = "N")]
    drive: f64,
    /// Frequency of that force in Hz; 0 is a constant one
    #[arg(long, default_value = "0", value_name = "HZ", value_parser = quantity::hertz)]
    drive_frequency: f64,
}

impl SystemArgs {
    /// The system and its initial state. Errors name the option with the invalid value.
    pub(super) fn build(&self) -> Result<(System, State)> {
        let spring = match self.spring {
            ForceLaw::Linear => Spring::Linear,
            ForceLaw::Duffing => Spring::Duffing { cubic: self.cubic },
            ForceLaw::Pendulum => Spring::Pendulum,
        };
        let system = System {
            mass: self.mass,
            stiffness: self.stiffness,
            damping: self.damping,
            target: self.target,
            spring,
            force: Force { amplitude: self.drive, frequency: self.drive_frequency, phase: 0.0 },
        };
        system.validate()?;
        Ok((system, State { x: self.x0, v: self.v0 }))
    }
}

/// The choice of methods.
#[derive(clap::Args)]
pub(super) struct MethodArgs {
    /// Methods, separated by commas: all, explicit-euler, implicit-euler, symplectic-euler, symplectic-euler-xv, heun,
    /// rk4, chou-semi-implicit, chou-implicit, synth-seed, synth-exact, verlet, exponential
    #[arg(long, default_value = "all", value_delimiter = ',', value_name = "all|A,B,…",
        add = ArgValueCandidates::new(|| Method::ALL.map(|method| CompletionCandidate::new(method.key())).into()))]
    methods: Vec<String>,
}

impl MethodArgs {
    /// The methods that the user named, in that order, each once.
    pub(super) fn named(&self) -> Result<Vec<Method>> {
        if self.is_all() {
            return Ok(Method::ALL.to_vec());
        }
        let mut methods = Vec::new();
        for key in &self.methods {
            let method = Method::from_key(key.trim())?;
            if !methods.contains(&method) {
                methods.push(method);
            }
        }
        Ok(methods)
    }

    /// The methods that the user named. For `all`, methods that cannot integrate the system are left out, with a note.
    pub(super) fn for_system(&self, system: &System, steps: &[f64]) -> Result<Vec<Method>> {
        let mut methods = self.named()?;
        if self.is_all() {
            methods.retain(|method| {
                // A step that is invalid for every method is reported later, as an error.
                let refused = steps.iter().filter(|h| **h > 0.0).find_map(|h| method.check(system, *h).err());
                if let Some(error) = &refused {
                    complain("note", format!("without {}: {error}", method.key()));
                }
                refused.is_none()
            });
        }
        Ok(methods)
    }

    fn is_all(&self) -> bool {
        self.methods.iter().any(|key| key.trim() == "all")
    }
}
