//! The methods: their names, accuracy and sources, and what they can integrate.

mod chou;
mod explicit_euler;
mod exponential;
mod heun;
mod implicit_euler;
mod integrator;
mod runge_kutta;
mod symplectic_euler;
mod synth_step;
mod verlet;

use super::system::System;
use crate::error::{Error, Result, nearest};

pub(crate) use integrator::Integrator;

/// How fast a method's error falls as the step shrinks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// In proportion to this power of the step.
    Power(u8),
    /// No error except rounding, for a linear spring without a force.
    Exact,
}

/// A way to integrate a mass on a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Position and velocity both from the old state.
    ExplicitEuler,
    /// Position and velocity both from the new state.
    ImplicitEuler,
    /// Velocity from the old position, position from the new velocity.
    SymplecticEuler,
    /// Position from the old velocity, velocity from the new position.
    SymplecticEulerPositionFirst,
    /// The mean of the slopes at both ends of an explicit Euler step.
    Heun,
    /// The classical fourth-order Runge–Kutta method.
    RungeKutta4,
    /// Chou's semi-implicit spring.
    ChouSemiImplicit,
    /// Chou's implicit spring.
    ChouImplicit,
    /// The synth's step with the coefficients of its first publication.
    SynthSeed,
    /// The synth's step with exact coefficients.
    SynthExact,
    /// Störmer–Verlet.
    Verlet,
    /// The exact exponential map.
    Exponential,
}

impl Method {
    /// Every method, in the order in which they are listed.
    pub const ALL: [Self; 12] = [
        Self::ExplicitEuler,
        Self::ImplicitEuler,
        Self::SymplecticEuler,
        Self::SymplecticEulerPositionFirst,
        Self::Heun,
        Self::RungeKutta4,
        Self::ChouSemiImplicit,
        Self::ChouImplicit,
        Self::SynthSeed,
        Self::SynthExact,
        Self::Verlet,
        Self::Exponential,
    ];

    /// Its name on the command line, in tables and in file names.
    pub fn key(self) -> &'static str {
        match self {
            Self::ExplicitEuler => "explicit-euler",
            Self::ImplicitEuler => "implicit-euler",
            Self::SymplecticEuler => "symplectic-euler",
            Self::SymplecticEulerPositionFirst => "symplectic-euler-xv",
            Self::Heun => "heun",
            Self::RungeKutta4 => "rk4",
            Self::ChouSemiImplicit => "chou-semi-implicit",
            Self::ChouImplicit => "chou-implicit",
            Self::SynthSeed => "synth-seed",
            Self::SynthExact => "synth-exact",
            Self::Verlet => "verlet",
            Self::Exponential => "exponential",
        }
    }

    /// Its name in figures.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::ExplicitEuler => "explicit Euler",
            Self::ImplicitEuler => "implicit Euler",
            Self::SymplecticEuler => "symplectic Euler (v, x)",
            Self::SymplecticEulerPositionFirst => "symplectic Euler (x, v)",
            Self::Heun => "Heun",
            Self::RungeKutta4 => "Runge–Kutta 4",
            Self::ChouSemiImplicit => "Chou, semi-implicit",
            Self::ChouImplicit => "Chou, implicit",
            Self::SynthSeed => "synth step, seed",
            Self::SynthExact => "synth step, exact",
            Self::Verlet => "Störmer–Verlet",
            Self::Exponential => "exponential map",
        }
    }

    /// Order of accuracy of the trajectory over a fixed time.
    pub fn order(self) -> Order {
        match self {
            Self::ExplicitEuler
            | Self::ImplicitEuler
            | Self::SymplecticEuler
            | Self::SymplecticEulerPositionFirst
            | Self::ChouSemiImplicit
            | Self::ChouImplicit
            | Self::SynthSeed => Order::Power(1),
            Self::Heun | Self::Verlet => Order::Power(2),
            Self::RungeKutta4 => Order::Power(4),
            Self::SynthExact | Self::Exponential => Order::Exact,
        }
    }

    /// Where the method was published.
    pub(crate) fn source(self) -> &'static str {
        match self {
            Self::ExplicitEuler => "Euler 1768",
            Self::ImplicitEuler => "Euler 1768; Hairer & Wanner 1996, §IV.3",
            Self::SymplecticEuler | Self::SymplecticEulerPositionFirst => {
                "de Vogelaere 1956; Hairer et al. 2006, §I.1.2"
            }
            Self::Heun => "Heun 1900",
            Self::RungeKutta4 => "Kutta 1901",
            Self::ChouSemiImplicit | Self::ChouImplicit => "Chou 2015, Precise Control over Numeric Springing",
            Self::SynthSeed => "I turned jiggle physics code into a synthesizer, Initialise and Step",
            Self::SynthExact => "this crate's oscillator",
            Self::Verlet => "Störmer 1907; Verlet 1967; with damping Brünger, Brooks & Karplus 1984",
            Self::Exponential => "Lagrange; Hairer et al. 2006, §XIII.1.2 (forced: midpoint rule)",
        }
    }

    /// The method with this name. For an unknown name, the error suggests the closest one.
    pub fn from_key(key: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|method| method.key() == key).ok_or_else(|| {
            let keys = Self::ALL.map(Self::key);
            let hint = nearest(key, keys).map_or(String::new(), |near| format!("; the nearest is {near}"));
            Error::value("methods", format!("{key} is not one of all, {}{hint}", keys.join(", ")))
        })
    }

    /// Returns an error if the method cannot integrate this system with steps of `h` seconds.
    pub fn check(self, system: &System, h: f64) -> Result<()> {
        self.integrator(system, h).map(drop)
    }

    /// The method with steps of `h` seconds. Returns an error if it cannot integrate this system.
    pub(crate) fn integrator(self, system: &System, h: f64) -> Result<Box<dyn Integrator>> {
        system.validate()?;
        if !(h > 0.0 && h.is_finite()) {
            return Err(Error::value("steps", format!("a step must be longer than 0 s, got {h}")));
        }
        let system = *system;
        Ok(match self {
            Self::ExplicitEuler => Box::new(explicit_euler::ExplicitEuler { system, h }),
            Self::ImplicitEuler => Box::new(implicit_euler::ImplicitEuler { system, h }),
            Self::SymplecticEuler => Box::new(symplectic_euler::VelocityFirst { system, h }),
            Self::SymplecticEulerPositionFirst => Box::new(symplectic_euler::PositionFirst { system, h }),
            Self::Heun => Box::new(heun::Heun { system, h }),
            Self::RungeKutta4 => Box::new(runge_kutta::RungeKutta4 { system, h }),
            Self::ChouSemiImplicit => Box::new(chou::SemiImplicit(chou::Spring::new(self.linear(&system)?, h)?)),
            Self::ChouImplicit => Box::new(chou::Implicit(chou::Spring::new(self.linear(&system)?, h)?)),
            Self::SynthSeed => Box::new(synth_step::SynthStep::seed(self.linear(&system)?, h)?),
            Self::SynthExact => Box::new(synth_step::SynthStep::exact(self.linear(&system)?, h)?),
            Self::Verlet => Box::new(verlet::Verlet { system, h }),
            Self::Exponential => Box::new(exponential::Exponential::new(self.linear(&system)?, h)),
        })
    }

    fn linear(self, system: &System) -> Result<&System> {
        if system.is_linear() {
            Ok(system)
        } else {
            Err(Error::value("spring", format!("must be linear for {}", self.key())))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::system::{Spring, State};

    #[test]
    fn names_lead_back_to_their_methods() {
        for method in Method::ALL {
            assert_eq!(Method::from_key(method.key()).unwrap(), method);
        }
        let message = Method::from_key("explicit_euler").unwrap_err().to_string();
        assert!(message.ends_with("the nearest is ‘explicit-euler’"), "{message}");
    }

    #[test]
    fn what_a_method_cannot_do_is_an_error() {
        let linear = System::linear(1.0, 50.0, 0.0).unwrap();
        let unsprung = System::linear(1.0, 0.0, 1.0).unwrap();
        let pendulum = System { spring: Spring::Pendulum, ..linear };
        for (method, system, h, says) in [
            (Method::Heun, linear, 0.0, "steps: a step must be longer than 0 s, got 0"),
            (Method::Heun, linear, f64::NAN, "got NaN"),
            (Method::ChouImplicit, unsprung, 0.01, "stiffness: must be greater than 0"),
            (Method::SynthSeed, unsprung, 0.01, "stiffness: must be greater than 0"),
            (Method::SynthExact, pendulum, 0.01, "spring: must be linear for synth-exact"),
            (Method::Exponential, pendulum, 0.01, "spring: must be linear for exponential"),
        ] {
            let message = method.integrator(&system, h).err().map(|error| error.to_string()).unwrap_or_default();
            assert!(message.contains(says), "{method:?}: {message}");
        }
    }

    /// One step of h = 0.1 from (0.5, 0.2) with k = 50, m = 1, computed by hand.
    #[test]
    fn first_steps_are_those_of_the_formulas() {
        let system = System::linear(1.0, 50.0, 0.0).unwrap();
        let start = State { x: 0.5, v: 0.2 };
        for (method, x, v) in [
            (Method::ExplicitEuler, 0.52, -2.3),
            (Method::ImplicitEuler, 0.52 / 1.5, -2.3 / 1.5),
            (Method::SymplecticEuler, 0.27, -2.3),
            (Method::SymplecticEulerPositionFirst, 0.52, -2.4),
            (Method::Heun, 0.395, -2.35),
            (Method::ChouSemiImplicit, 0.27, -2.3),
            (Method::ChouImplicit, 0.52 / 1.5, -2.3 / 1.5),
            (Method::Verlet, 0.395, -2.0375),
        ] {
            let got = method.integrator(&system, 0.1).unwrap().step(start, 0.0).unwrap();
            assert!((got.x - x).abs() < 1e-14 && (got.v - v).abs() < 1e-14, "{method:?}: {got:?}");
        }
    }
}
