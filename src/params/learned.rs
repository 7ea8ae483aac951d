//! Controllers that users bind to parameters, and how one takes hold of its parameter without a jump.

use super::{PARAMS, Param, ParamInfo};
use std::collections::BTreeMap;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicU8, AtomicU16};

/// The parameter that each bound controller moves, on any channel, by the controller's number. No parameter has two.
pub type Controllers = BTreeMap<u8, Param>;

/// Binds a controller to a parameter, in place of what either was bound to; without a controller, the parameter has none.
pub(crate) fn bind(controllers: &mut Controllers, param: Param, controller: Option<u8>) {
    controllers.retain(|_, bound| *bound != param);
    if let Some(controller) = controller {
        controllers.insert(controller, param);
    }
}

/// Refuses the numbers that are parts of messages: what they say would be lost, or be taken for a position.
///
/// # Errors
/// What the controller is for.
pub fn check_controller(controller: u8) -> Result<(), String> {
    match duty(controller) {
        None => Ok(()),
        Some(duty) => Err(format!(
            "controller {controller} {duty}, and cannot move a parameter: expected 1 to 119 without 6, 32, 38 and 96 to 101"
        )),
    }
}

/// What a number is for that is no knob, fader, pedal or switch. Real-time safe.
const fn duty(controller: u8) -> Option<&'static str> {
    match controller {
        0 | 32 => Some("selects banks"),
        6 | 38 | 96..=101 => Some("sets registered parameters"),
        120.. => Some("ends notes and sets modes"),
        _ => None,
    }
}

/// Whether a number is that of a pedal or switch, whose last position goes on acting.
const fn is_pedal(controller: u8) -> bool {
    matches!(controller, 64..=69)
}

/// Nobody waits for a controller, or somebody does; any other number is that of the one that came.
const IDLE: u8 = 255;
const LISTENING: u8 = 254;

/// The bindings as the audio thread reads them. Any thread may change them at any time.
pub struct Learned {
    /// Place of each controller's parameter in the table plus 1; 0 for none.
    places: [AtomicU16; 128],
    listener: AtomicU8,
}

impl Default for Learned {
    fn default() -> Self {
        Self { places: [const { AtomicU16::new(0) }; 128], listener: AtomicU8::new(IDLE) }
    }
}

impl Learned {
    /// Replaces all bindings.
    pub fn publish(&self, controllers: &Controllers) {
        for (controller, place) in (0..).zip(&self.places) {
            place.store(controllers.get(&controller).map_or(0, |param| *param as u16 + 1), Relaxed);
        }
    }

    /// The parameter that a controller moves. Real-time safe.
    pub fn param(&self, controller: u8) -> Option<&'static ParamInfo> {
        let place = self.places.get(usize::from(controller))?.load(Relaxed);
        PARAMS.get(usize::from(place.checked_sub(1)?))
    }

    /// The controller that moves a parameter.
    pub fn controller_of(&self, param: Param) -> Option<u8> {
        (0..128).find(|controller| self.param(*controller).is_some_and(|info| info.param == param))
    }

    /// Waits for the next controller that moves; until [`Learned::stop`], none that can be bound does anything else.
    pub fn listen(&self) {
        self.listener.store(LISTENING, Relaxed);
    }

    /// Whether somebody waits, and nothing has moved yet.
    pub fn is_listening(&self) -> bool {
        self.listener.load(Relaxed) == LISTENING
    }

    /// The controller that has moved since [`Learned::listen`].
    pub fn heard(&self) -> Option<u8> {
        Some(self.listener.load(Relaxed)).filter(|heard| *heard < 128)
    }

    /// Waits no longer.
    pub fn stop(&self) {
        self.listener.store(IDLE, Relaxed);
    }

    /// Tells whoever waits that a controller has moved. Returns whether it is to do nothing else. Real-time safe.
    fn hear(&self, controller: u8) -> bool {
        if self.listener.load(Relaxed) == IDLE {
            return false;
        }
        let _ = self.listener.compare_exchange(LISTENING, controller, Relaxed, Relaxed);
        duty(controller).is_none()
    }
}

/// What becomes of a controller's movement.
#[derive(Clone, Copy, Debug)]
pub enum Movement {
    /// It does what it does without bindings.
    Free,
    /// Nothing: its parameter is somewhere else, or somebody waits for a controller to bind.
    Nothing,
    /// It is the new position of this parameter's knob.
    Turns(&'static ParamInfo),
}

/// Which controllers have hold of their parameters, in one instrument.
///
/// A parameter that something else has moved (a host, a preset, a mouse) would jump to where its controller happens to stand. So
/// a controller has no hold of it until its own movement reaches or passes the parameter's present position.
#[derive(Debug)]
pub struct Takeover([Hold; 128]);

#[derive(Clone, Copy, Debug, Default)]
struct Hold {
    /// Where the controller stands, 0–1, if it has moved yet.
    at: Option<f32>,
    /// The value that it has given to its parameter, if it had hold of it.
    given: Option<(Param, f32)>,
    /// Whether it is a pedal that was pressed as one, and not let go of yet.
    is_down: bool,
}

impl Default for Takeover {
    fn default() -> Self {
        Self([Hold::default(); 128])
    }
}

/// Smallest movement of a controller: what is as near counts as reached.
const STEP: f32 = 1.0 / 127.0;

impl Takeover {
    /// Follows a controller to a position, 0–1. `present` says the value of a parameter, without modulation. Real-time safe.
    pub fn follow(
        &mut self,
        learned: &Learned,
        controller: u8,
        at: f32,
        present: impl FnOnce(&'static ParamInfo) -> f32,
    ) -> Movement {
        let Some(hold) = self.0.get_mut(usize::from(controller)) else { return Movement::Free };
        let before = hold.at.replace(at).unwrap_or(at);
        let is_heard = learned.hear(controller);
        let param = learned.param(controller).filter(|_| !is_heard);
        // A pedal that is bound while it is down would hold its notes for ever.
        if hold.is_down || !is_heard && param.is_none() {
            hold.is_down = is_pedal(controller) && at > 0.0;
            return Movement::Free;
        }
        let Some(info) = param else { return Movement::Nothing };
        let (present, value) = (present(info), info.denormalise(at.into()));
        let position = info.normalise(present) as f32;
        let reached = before.min(at) - STEP..=before.max(at) + STEP;
        let has_hold = hold.given == Some((info.param, present)) || value == present || reached.contains(&position);
        hold.given = has_hold.then_some((info.param, value));
        if has_hold { Movement::Turns(info) } else { Movement::Nothing }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A controller bound to a parameter, which stands at a position.
    struct Knob {
        learned: Learned,
        takeover: Takeover,
        info: &'static ParamInfo,
        position: f32,
    }

    impl Knob {
        fn new(param: Param, position: f32) -> Self {
            let learned = Learned::default();
            learned.publish(&Controllers::from([(21, param)]));
            Self { learned, takeover: Takeover::default(), info: param.info(), position }
        }

        /// Moves the controller, 0–127. Returns whether the parameter follows.
        fn turn(&mut self, to: u8) -> bool {
            let (at, present) = (f32::from(to) / 127.0, self.info.denormalise(self.position.into()));
            let movement = self.takeover.follow(&self.learned, 21, at, |_| present);
            let Movement::Turns(info) = movement else { return false };
            assert_eq!(info.param, self.info.param);
            self.position = at;
            true
        }
    }

    #[test]
    fn a_controller_takes_hold_where_it_reaches_or_passes_the_parameter() {
        for (start, path, followed) in [
            (0.5, &[10, 40, 62, 63, 64, 100][..], &[false, false, false, true, true, true][..]),
            (0.5, &[10, 100, 20], &[false, true, true]),
            (0.5, &[127, 90, 10], &[false, false, true]),
            (0.0, &[5, 2, 0, 90], &[false, false, true, true]),
            (1.0, &[5, 127], &[false, true]),
            // It stands there already.
            (0.5, &[64, 100], &[true, true]),
        ] {
            let mut knob = Knob::new(Param::Decay, start);
            assert_eq!(path.iter().map(|to| knob.turn(*to)).collect::<Vec<_>>(), followed, "{start} {path:?}");
        }
    }

    #[test]
    fn what_something_else_has_moved_must_be_reached_again() {
        let mut knob = Knob::new(Param::Decay, 0.5);
        assert!(knob.turn(64) && knob.turn(70) && knob.turn(80));
        knob.position = 0.1;
        assert!(!knob.turn(81) && !knob.turn(40) && knob.turn(12), "a preset has set it");
        // Back to where it was before the last movement: still something else.
        knob.turn(40);
        knob.position = 12.0 / 127.0;
        assert!(!knob.turn(41));
    }

    #[test]
    fn steps_of_a_choice_are_reached_by_any_position_of_theirs() {
        let mut knob = Knob::new(Param::Mode, 0.0);
        let last = knob.info.choices.len() as f32 - 1.0;
        assert!(!knob.turn(127) && knob.turn((0.2 / last * 127.0) as u8), "the first choice");
        let mut most = 0.0;
        for to in 0..128 {
            assert!(knob.turn(to), "{to}");
            // As a host stores it: as a whole step.
            knob.position = knob.info.normalise(knob.info.denormalise(knob.position.into())) as f32;
            most = knob.position;
        }
        assert_eq!(most, 1.0);
    }

    #[test]
    fn while_somebody_listens_controllers_do_nothing_else_and_parts_of_messages_stay_those() {
        let learned = Learned::default();
        learned.publish(&Controllers::from([(21, Param::Decay)]));
        let mut takeover = Takeover::default();
        let mut follow = |controller| takeover.follow(&learned, controller, 0.5, |info| info.denormalise(0.5));
        assert!(matches!(follow(21), Movement::Turns(_)) && matches!(follow(7), Movement::Free));
        learned.listen();
        assert!(
            matches!(follow(101), Movement::Free) && learned.heard() == Some(101),
            "it is told why it cannot be bound"
        );
        learned.listen();
        assert!(learned.heard().is_none() && matches!(follow(7), Movement::Nothing));
        assert!(matches!(follow(21), Movement::Nothing) && learned.heard() == Some(7), "the first one counts");
        learned.stop();
        assert!(matches!(follow(21), Movement::Turns(_)) && learned.heard().is_none());
    }

    #[test]
    fn a_pedal_turns_a_knob_but_lets_go_of_its_notes_first() {
        let learned = Learned::default();
        let mut takeover = Takeover::default();
        let mut follow = |learned: &Learned, at| takeover.follow(learned, 64, at, |info| info.denormalise(0.0));
        learned.listen();
        assert!(matches!(follow(&learned, 1.0), Movement::Nothing) && learned.heard() == Some(64));
        learned.stop();
        // Pressed as a pedal, and bound before it is let go of.
        assert!(matches!(follow(&learned, 1.0), Movement::Free));
        learned.publish(&Controllers::from([(64, Param::Decay)]));
        learned.listen();
        assert!(matches!(follow(&learned, 0.4), Movement::Free) && learned.heard() == Some(64));
        learned.stop();
        assert!(matches!(follow(&learned, 0.0), Movement::Free), "half a pedal holds too");
        assert!(matches!(follow(&learned, 1.0), Movement::Turns(info) if info.param == Param::Decay));
        assert!(matches!(follow(&learned, 0.0), Movement::Turns(_)));
    }

    #[test]
    fn a_parameter_has_one_controller_and_a_controller_one_parameter() {
        let (learned, mut controllers) = (Learned::default(), Controllers::new());
        for (param, controller) in [(Param::Decay, 21), (Param::Gain, 22), (Param::Decay, 23), (Param::Tilt, 22)] {
            bind(&mut controllers, param, Some(controller));
        }
        assert_eq!(controllers, Controllers::from([(22, Param::Tilt), (23, Param::Decay)]));
        learned.publish(&controllers);
        let of = |param| learned.controller_of(param);
        assert_eq!((of(Param::Tilt), of(Param::Decay), of(Param::Gain)), (Some(22), Some(23), None));
        bind(&mut controllers, Param::Tilt, None);
        learned.publish(&controllers);
        assert!(learned.param(22).is_none() && learned.param(200).is_none());
    }

    #[test]
    fn only_parts_of_messages_are_refused_with_a_word_and_what_would_be_right() {
        let free: Vec<u8> = (0..=255).filter(|controller| check_controller(*controller).is_ok()).collect();
        let right =
            (1..=119).filter(|controller| ![6, 32, 38].contains(controller) && !(96..=101).contains(controller));
        assert_eq!(free, right.collect::<Vec<u8>>());
        for (controller, word) in
            [(0, "banks"), (38, "registered"), (101, "registered"), (123, "notes"), (255, "modes")]
        {
            let message = check_controller(controller).unwrap_err();
            assert!(message.contains(word) && message.contains(&controller.to_string()), "{message}");
            assert!(message.ends_with("expected 1 to 119 without 6, 32, 38 and 96 to 101"), "{message}");
        }
    }
}
