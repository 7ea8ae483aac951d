//! A CLAP host made with clack, used by every test.

pub(crate) mod bundle;
mod calls;
mod event;
mod instance;
mod player;
pub(crate) mod reference;

pub(crate) use calls::{PresetCall, text};
pub(crate) use event::{Address, Sent, Timed};
pub(crate) use instance::{Instance, Parameter, open};
pub(crate) use player::{Ended, Player, Rendered};
