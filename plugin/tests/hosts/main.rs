//! The plugin in real hosts: CLAP in clack; VST3 in pedalboard, dawdreamer and our own host; windows under Xvfb.
//!
//! What needs the system's loader, screen or Python is tested on Linux alone. `plugin/tests/README.md` lists what is covered and
//! where.

mod automation;
mod contexts;
#[cfg(target_os = "linux")]
mod controllers;
#[cfg(target_os = "linux")]
mod cpu;
mod damage;
#[cfg(target_os = "linux")]
mod devices;
#[cfg(target_os = "linux")]
mod drag;
#[cfg(target_os = "linux")]
mod drops;
mod expression;
mod fuzz;
#[cfg(target_os = "linux")]
mod growth;
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "tests on Linux use more of it"))]
mod host;
#[cfg(target_os = "linux")]
mod host_menu;
mod lifecycle;
#[cfg(target_os = "linux")]
mod minutes;
mod multi;
mod names;
mod notes;
mod parameters;
mod patches;
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "tests on Linux use more of it"))]
mod phrase;
#[cfg(target_os = "linux")]
mod pixels;
mod presets;
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "tests on Linux use more of it"))]
mod process;
#[cfg(target_os = "linux")]
mod realtime;
mod resonator;
mod scan;
#[cfg(target_os = "linux")]
mod screen;
#[cfg(target_os = "linux")]
mod screen_reader;
#[cfg(target_os = "linux")]
mod sizes;
mod song;
#[cfg(target_os = "linux")]
mod standalone;
mod state;
#[cfg(target_os = "linux")]
mod storm;
mod thorough;
#[cfg(target_os = "linux")]
mod tuning;
#[cfg(target_os = "linux")]
mod vst3;
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "tests on Linux use more of it"))]
mod vst3_host;
mod vst3_state;
#[cfg(target_os = "linux")]
mod window;

use libtest_mimic::{Arguments, Trial};
use std::process::ExitCode;
#[cfg(target_os = "linux")]
use std::sync::LazyLock;

/// What a test needs besides Rust.
#[derive(Clone, Copy)]
#[cfg_attr(not(target_os = "linux"), allow(dead_code, reason = "elsewhere, tests need nothing"))]
enum Needs {
    Nothing,
    /// A virtual screen (Xvfb).
    Screen,
    /// A screen, and a bus for screen readers.
    ScreenReader,
    /// A screen, the program and a JACK server.
    Program,
    /// The Python hosts.
    Python,
    /// The Python hosts and a screen.
    PythonAndScreen,
}

impl Needs {
    /// Whether tests with these needs wait for time to pass: what is on a screen comes when it comes.
    fn wait(self) -> bool {
        !matches!(self, Needs::Nothing | Needs::Python)
    }

    #[cfg(not(target_os = "linux"))]
    fn missing(self) -> Option<String> {
        None
    }

    /// The first need that is missing on this machine; `None` if all are met.
    #[cfg(target_os = "linux")]
    fn missing(self) -> Option<String> {
        static SCREEN: LazyLock<Option<String>> = LazyLock::new(screen::missing);
        static PYTHON: LazyLock<Option<String>> = LazyLock::new(vst3::missing);
        match self {
            Needs::Nothing => None,
            Needs::Screen => SCREEN.clone(),
            Needs::ScreenReader => screen_reader::missing().or_else(|| SCREEN.clone()),
            Needs::Program => standalone::missing().or_else(|| SCREEN.clone()),
            Needs::Python => PYTHON.clone(),
            Needs::PythonAndScreen => PYTHON.clone().or_else(|| SCREEN.clone()),
        }
    }
}

/// Tests that go through a part of their cases, and through all of them in the long suite.
const IN_FULL: [&str; 14] = [
    "fuzz::random_events_give_clean_sound_at_every_rate",
    "fuzz::random_events_sound_the_same_in_all_blocks",
    "fuzz::random_settings_sound_clean",
    "lifecycle::every_rate_and_block_size_plays",
    "resonator::a_held_chord_has_the_bits_of_the_command",
    "song::one_channel_has_the_bits_of_the_command",
    "song::an_mpe_performance_has_the_bits_of_the_command",
    "song::a_kit_has_the_bits_of_the_command",
    "song::sound_that_comes_in_has_the_bits_of_the_command",
    "song::sixteen_channels_have_the_bits_of_one_synth",
    "state::what_is_saved_comes_back_to_the_byte",
    "state::two_states_in_turn_while_audio_runs_are_never_mixed",
    "vst3::one_channel_has_the_bits_of_the_command",
    "vst3::what_is_saved_comes_back",
];

/// Makes the list of tests from their modules and names, with the needs of each module.
macro_rules! trials {
    ($($needs:ident: $module:ident { $($test:ident)* })*) => {
        vec![$($((concat!(stringify!($module), "::", stringify!($test)), Needs::$needs, $module::$test as fn()),)*)*]
    };
}

fn main() -> ExitCode {
    #[cfg(target_os = "linux")]
    if let Some(work) = process::work() {
        return match work.as_str() {
            "growth" | "reopen" => growth::work(&work),
            "storm" | "endings" => storm::work(&work),
            "menu-clap" | "menu-vst3" => host_menu::work(&work),
            "users-sounds" => presets::work(),
            "screen-reader" => screen_reader::work(),
            "window-cpu" => cpu::work(),
            "window-pixels" => pixels::work(),
            "sizes-clap" | "sizes-vst3" | "zooms-clap" | "zooms-vst3" | "dots" => sizes::work(&work),
            "window" | "window-keys" | "window-playing" => window::work(&work),
            "tuning" => tuning::work(),
            "controllers" => controllers::work(),
            _ => realtime::work(&work),
        };
    }
    let everywhere = trials! {
        Nothing: scan {
            the_descriptor_is_complete
            no_other_plugin_is_made
            all_symbols_are_found_at_once
            factory_presets_are_in_the_library_once
            one_stereo_output_comes_first_and_every_layout_is_valid
            notes_come_in_by_clap_and_midi
            latency_voices_and_rendering_are_told
        }
        Nothing: parameters {
            ids_are_those_of_the_table_for_ever
            all_of_the_table_is_told
            a_new_instance_has_the_defaults
            texts_and_values_go_both_ways
            what_people_type_is_understood_or_refused
            a_flush_sets_values
            senseless_values_and_unknown_ids_change_nothing_else
            remote_control_pages_begin_with_what_one_turns_first_and_have_every_parameter_once
        }
        Nothing: lifecycle {
            every_rate_and_block_size_plays
            reset_and_reactivation_start_anew
            instances_do_not_hear_each_other
            instances_on_several_threads_play_at_once
            every_layout_plays_and_ignores_its_input
            the_tail_is_exact_and_then_the_plugin_may_sleep
            blocks_without_frames_and_short_blocks_do_no_harm
            starts_and_stops_need_no_block_in_between
            a_host_without_thread_checks_gets_the_same
            audio_may_run_on_any_thread
        }
        Nothing: notes {
            a_note_ends_when_its_sound_does
            every_note_ends_once_also_when_stolen_or_struck_again
            held_notes_end_once_when_mono_becomes_poly
            a_stolen_note_ends_when_it_is_stolen
            notes_are_found_by_id_key_channel_or_not_at_all
            a_choke_silences_within_a_fade
            stray_events_do_no_harm
            a_flood_of_events_loses_none
        }
        Nothing: multi {
            sixteen_stereo_outputs_follow_the_main_one
            pads_go_to_their_outputs_which_add_up_to_the_plain_plugin
            channels_go_to_the_outputs_of_their_numbers
            states_move_between_both
        }
        Nothing: automation {
            a_parameter_changes_at_its_frame
            changes_may_be_as_dense_as_frames
        }
        Nothing: expression {
            modulation_moves_one_voice_or_all
            modulation_moves_the_notes_of_a_key_or_a_channel
            expressions_reach_their_notes
            mpe_is_heard_by_channel
            the_tempo_is_handed_on
        }
        Nothing: state {
            what_is_saved_comes_back_to_the_byte
            every_way_to_set_values_leaves_the_same_state
            modulation_is_not_saved
            a_state_loaded_while_all_is_modulated_is_what_is_saved
            a_state_loaded_while_processing_is_heard_exactly
            touching_a_knob_keeps_the_exact_value
            streams_may_deliver_a_byte_at_a_time
            a_kit_comes_back_with_its_presets
            states_of_all_versions_load
            parameters_that_a_state_lacks_have_their_defaults
            two_states_in_turn_while_audio_runs_are_never_mixed
        }
        Nothing: contexts {
            a_preset_neither_has_nor_brings_the_window
            all_other_contexts_are_alike
        }
        Nothing: names {
            pads_have_their_names_at_their_keys
            the_host_is_told_when_names_change
        }
        Nothing: presets {
            every_sound_of_the_factory_is_listed_once
            sounds_of_the_factory_load_by_their_keys_in_every_plugin
            a_listing_ends_when_the_host_has_enough
            what_cannot_be_loaded_is_told_and_changes_nothing
        }
        Nothing: damage {
            what_is_no_state_changes_nothing
            what_can_be_read_of_a_state_is_taken_over
            damaged_states_never_leave_half_a_patch
        }
        Nothing: fuzz {
            random_events_give_clean_sound_at_every_rate
            random_events_sound_the_same_in_all_blocks
            random_settings_sound_clean
            wild_values_sound_clean
        }
        Nothing: song {
            one_channel_has_the_bits_of_the_command
            an_mpe_performance_has_the_bits_of_the_command
            a_kit_has_the_bits_of_the_command
            sound_that_comes_in_has_the_bits_of_the_command
            sixteen_channels_have_the_bits_of_one_synth
        }
        Nothing: resonator {
            the_factory_has_it_beside_the_instrument
            its_ports_are_as_wide_in_as_out
            a_held_chord_has_the_bits_of_the_command
            notes_have_the_bits_of_the_command
            notes_replace_the_chord_at_their_frames
            its_state_comes_back_and_is_that_of_the_instrument
            silence_gives_silence_after_the_tail
            at_a_mix_of_0_the_sound_is_as_it_was
        }
        Nothing: vst3_state {
            parameters_have_the_numbers_of_their_ids
            states_of_all_versions_load
        }
    };
    #[cfg(not(target_os = "linux"))]
    let on_linux = vec![];
    #[cfg(target_os = "linux")]
    let on_linux = trials! {
        Nothing: presets {
            the_users_sounds_are_listed_and_load
        }
        Nothing: growth {
            hundreds_of_instances_leave_nothing_behind
            the_library_can_be_opened_and_closed_again
        }
        Nothing: realtime {
            the_watch_bites
        }
        Nothing: tuning {
            a_master_of_mts_esp_is_followed
        }
        Nothing: controllers {
            a_bound_controller_has_the_bits_of_the_engine
        }
        Nothing: realtime {
            process_neither_allocates_nor_locks_nor_calls_the_system
            nor_does_the_effect
        }
        Screen: realtime {
            nor_does_it_with_the_window_open
        }
        Screen: window {
            opens_and_closes_fifty_times
            opens_and_closes_while_audio_runs
            keys_go_to_the_host_unless_somebody_types
        }
        Screen: host_menu {
            opens_in_a_clap_host
            opens_in_a_vst3_host
        }
        Screen: pixels {
            the_real_window_has_the_pixels_of_the_accepted_picture
        }
        Screen: sizes {
            every_opening_is_whole_at_every_zoom_and_scale_in_clap
            every_opening_is_whole_at_every_zoom_and_scale_in_vst3
            a_zoom_that_is_chosen_stays_in_clap
            a_zoom_that_is_chosen_stays_in_vst3
            a_screen_with_dense_dots_has_a_whole_window
        }
        Screen: cpu {
            a_silent_window_draws_nothing
        }
        ScreenReader: screen_reader {
            it_reads_and_turns_knobs_and_the_library_can_be_closed
        }
        Program: standalone {
            it_keeps_its_state_whatever_ends_it
            a_broken_state_is_set_aside
            what_is_missing_is_said
            without_a_sound_card_it_plays_on_the_server_or_waits_for_a_device
            keys_search_and_undo_and_zoom
        }
        Program: minutes {
            the_first_five_minutes
        }
        Program: devices {
            another_device_is_chosen_while_it_plays
        }
        Program: drops {
            a_recording_that_is_dropped_on_the_real_window_becomes_the_sound
        }
        Nothing: storm {
            instances_end_while_their_changes_are_told
        }
        Screen: storm {
            the_window_comes_and_goes_while_parameters_are_automated
        }
        Python: vst3 {
            every_parameter_can_be_set_and_read
            one_channel_has_the_bits_of_the_command
            a_kit_has_the_bits_of_the_command
            many_outputs_leave_the_main_one_as_it_is
            the_effect_has_the_bits_of_the_command
            what_is_saved_comes_back
            automation_has_the_bits_of_the_engine
        }
        PythonAndScreen: vst3 {
            the_window_opens_and_closes_fifty_times
        }
    };
    let trial = |(name, needs, test): (&str, Needs, fn()), in_full: bool| {
        let name = if in_full { format!("thorough::{name}") } else { name.to_owned() };
        let run = move || match needs.missing() {
            Some(missing) => Err(format!("it needs {missing}, which ‘cargo xtask setup --all’ installs").into()),
            None => {
                thorough::set(in_full);
                test();
                Ok(())
            }
        };
        Trial::test(name, run).with_ignored_flag(needs.wait() || in_full)
    };
    let tests: Vec<_> = everywhere.into_iter().chain(on_linux).collect();
    let in_full: Vec<_> = tests.iter().filter(|(name, ..)| IN_FULL.contains(name)).copied().collect();
    assert!(in_full.len() == IN_FULL.len() || !cfg!(target_os = "linux"), "each of them is a test");
    let tests =
        tests.into_iter().map(|test| trial(test, false)).chain(in_full.into_iter().map(|test| trial(test, true)));
    let conclusion = libtest_mimic::run(&Arguments::from_args(), tests.collect());
    host::bundle::remove();
    conclusion.exit_code()
}
