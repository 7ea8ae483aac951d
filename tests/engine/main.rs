//! The engine through its public interface: events in, samples out, and nothing allocated between them.

mod accuracy;
mod allocation;
mod any_event;
mod behind_voices;
mod blocks;
mod bodies;
mod body_reference;
mod body_rendered;
mod breath;
mod clicks;
mod controllers;
mod coupled_reference;
mod damped_sine;
mod damped_sine_itself;
mod events;
mod exciters;
mod hammers;
mod host_events;
mod in_blocks;
mod in_motion;
mod kits;
mod limiter;
mod modulation;
mod motion;
mod nudges;
mod outputs;
mod pair_reference;
mod pool;
mod seed_listing;
mod shared_space;
mod space;
mod storm;
mod tuning;
mod unison;
mod workers;

/// Forbids allocation wherever a test asks for it.
#[global_allocator]
static ALLOCATOR: assert_no_alloc::AllocDisabler = assert_no_alloc::AllocDisabler;
