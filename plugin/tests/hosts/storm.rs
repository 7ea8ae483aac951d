//! The VST3 while an audio thread automates it: windows open and close, instances are created and released.

use crate::process::{Stops, command, succeeds, wait_until};
use crate::screen::{Onlooker, Screen};
use crate::vst3_host::{Automation, Block, FRAMES, Frame, FrameWithoutLoop, Module, Vst3, threads_called};
use sprung::params::PARAMS;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;
use vst3::ComWrapper;
use vst3::Steinberg::IPlugFrame;
use vst3::Steinberg::Vst::ParamID;

/// Number of times that the window is opened and closed.
const WINDOWS: usize = 200;

/// Number of instances that are created and released.
const INSTANCES: usize = 200;

/// Windows opened before files and threads are counted: with the first windows, drivers load libraries that they keep.
const WARM_UP: usize = 5;

/// Name of the thread that the wrapper's instances share.
const WORKER: &str = "bg-worker";

pub(crate) fn the_window_comes_and_goes_while_parameters_are_automated() {
    let screen = Screen::new();
    let mut storm = command("storm");
    storm.env("DISPLAY", &screen.display);
    succeeds(storm);
}

pub(crate) fn instances_end_while_their_changes_are_told() {
    succeeds(command("endings"));
}

/// Runs in the processes that these tests start.
pub(crate) fn work(name: &str) -> ExitCode {
    if name == "storm" {
        windows()
    } else {
        endings()
    }
    ExitCode::SUCCESS
}

/// The ids of the parameters of the table.
fn parameters(plugin: &Vst3) -> Vec<ParamID> {
    (0..PARAMS.len() as i32).map(|index| plugin.parameter(index).expect("a parameter of the table").0).collect()
}

/// Processes on the calling thread until told to stop, with every parameter moving. Counts blocks.
fn automate(plugin: &Vst3, parameters: &[ParamID], stop: &AtomicBool, blocks: &AtomicUsize) {
    let mut peak = 0.0_f32;
    while !stop.load(Ordering::Relaxed) {
        let block = blocks.load(Ordering::Relaxed);
        let key = block.is_multiple_of(128).then_some(40 + (block / 128 % 40) as i16);
        let Block(samples) = Block::process(plugin, Automation::of(parameters, block), key);
        let samples = samples.as_flattened();
        assert!(samples.iter().all(|sample| sample.is_finite()), "block {block}");
        peak = samples.iter().fold(peak, |peak, sample| peak.max(sample.abs()));
        blocks.store(block + 1, Ordering::Relaxed);
        std::thread::sleep(Duration::from_micros(FRAMES as u64 * 1_000_000 / 48_000));
    }
    assert!(peak > 0.0, "notes are heard");
}

/// Opens and closes the window repeatedly, in all the ways in which hosts do it.
fn windows() {
    let onlooker = Onlooker::new(None);
    let parent = onlooker.make_window();
    let module = Module::open();
    let plugin = Vst3::new(&module);
    let states = [plugin.save(), include_bytes!("../states/0.1.0.json").to_vec()];
    let parameters = parameters(&plugin);
    let frame = ComWrapper::new(Frame::default());
    let with_loop = frame.to_com_ptr::<IPlugFrame>().unwrap();
    let without_loop = ComWrapper::new(FrameWithoutLoop).to_com_ptr::<IPlugFrame>().unwrap();
    plugin.start();
    let (stop, blocks) = (AtomicBool::new(false), AtomicUsize::new(0));
    let mut held = None;
    std::thread::scope(|scope| {
        let stops = Stops(&stop);
        let playing = scope.spawn(|| automate(&plugin, &parameters, &stop, &blocks));
        wait_until("the first block", || blocks.load(Ordering::Relaxed) > 0);
        for time in 0..WINDOWS {
            if time == WARM_UP {
                held = Some(held_now());
            }
            // Hosts without a run loop are rare. Without one, the worker receives every change while the window is open.
            let has_loop = time % 4 != 3;
            let (before, _) = frame.registered();
            let view = plugin.open_window(if has_loop { &with_loop } else { &without_loop }, parent);
            assert_eq!(frame.registered(), (before + usize::from(has_loop), usize::from(has_loop)), "opening {time}");
            assert!(plugin.load(&states[time % 2]), "opening {time}");
            match time % 10 {
                // Long enough to draw.
                0 => (0..20).for_each(|_| frame.turn(10)),
                1..4 => {
                    let handled = frame.handled();
                    wait_until(&format!("changes on the run loop of window {time}"), || {
                        frame.turn(5);
                        !has_loop || frame.handled() > handled
                    });
                }
                // Closed at once, while changes are still waiting.
                _ => {}
            }
            // Sometimes a host releases a view without closing it. The next window, or the end of the instance, cleans
            // up.
            if time % 10 == 9 {
                view.close_carelessly()
            } else {
                view.close()
            }
            let left = usize::from(has_loop && time % 10 == 9);
            assert_eq!(frame.registered().1, left, "handlers on the run loop after opening {time}");
            frame.turn(0);
        }
        let view = plugin.open_window(&with_loop, parent);
        view.close();
        let held = held.expect("it was counted");
        // The clipboard's thread ends shortly after its window, so both counts may include one such thread more.
        wait_until(&format!("{held:?} files and threads, as after {WARM_UP} windows, not {:?}", held_now()), || {
            held_now().iter().zip(held).all(|(now, then)| *now <= then)
        });
        drop(stops);
        playing.join().unwrap();
    });
    assert!(blocks.into_inner() > WINDOWS, "it was automated all the while");
    plugin.stop();
    drop(plugin);
    let (registered, left) = frame.registered();
    assert_eq!((registered, left), (WINDOWS * 3 / 4 + 1, 0), "handlers that came, and that are left");
    workers_become(0);
}

/// Waits until this many workers run: the system needs a moment to remove a thread that has been joined.
#[track_caller]
fn workers_become(count: usize) {
    wait_until(&format!("{count} workers"), || threads_called(WORKER) == count);
}

/// Number of open files, and number of running threads.
fn held_now() -> [usize; 2] {
    ["/proc/self/fd", "/proc/self/task"].map(|folder| std::fs::read_dir(folder).unwrap().count())
}

/// Releases instances while the worker still receives their changes: some alone, some while others exist.
fn endings() {
    let module = Module::open();
    let stays = Vst3::new(&module);
    let parameters = parameters(&stays);
    let mut stays = Some(stays);
    for time in 0..INSTANCES {
        // Half of them are the only user of the worker, and end it.
        if time == INSTANCES / 2 {
            stays = None;
            workers_become(0);
        }
        let plugin = Vst3::new(&module);
        plugin.start();
        std::thread::scope(|scope| {
            // Several blocks in a row fill the worker's task list.
            scope.spawn(|| {
                for block in 0..time % 40 {
                    Block::process(&plugin, Automation::of(&parameters, block), None);
                }
            });
        });
        plugin.stop();
        drop(plugin);
        workers_become(usize::from(stays.is_some()));
    }
    // From here on, no code of the library may run.
    drop(module);
}
