//! Parameter rows of the three low-frequency oscillators.

macro_rules! lfo {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        lfo! { @ { $($before)* } [$next $($rest)*]
            "LFO 1" Lfo1Rate "lfo1_rate" "LFO 1 rate" Lfo1Sync "lfo1_sync" "LFO 1 sync"
                Lfo1Shape "lfo1_shape" "LFO 1 shape" Lfo1Phase "lfo1_phase" "LFO 1 phase"
                Lfo1Fade "lfo1_fade" "LFO 1 fade-in" Lfo1Scope "lfo1_scope" "LFO 1 scope";
            "LFO 2" Lfo2Rate "lfo2_rate" "LFO 2 rate" Lfo2Sync "lfo2_sync" "LFO 2 sync"
                Lfo2Shape "lfo2_shape" "LFO 2 shape" Lfo2Phase "lfo2_phase" "LFO 2 phase"
                Lfo2Fade "lfo2_fade" "LFO 2 fade-in" Lfo2Scope "lfo2_scope" "LFO 2 scope";
            "LFO 3" Lfo3Rate "lfo3_rate" "LFO 3 rate" Lfo3Sync "lfo3_sync" "LFO 3 sync"
                Lfo3Shape "lfo3_shape" "LFO 3 shape" Lfo3Phase "lfo3_phase" "LFO 3 phase"
                Lfo3Fade "lfo3_fade" "LFO 3 fade-in" Lfo3Scope "lfo3_scope" "LFO 3 scope";
        }
    };
    (@ { $($before:tt)* } [$next:ident $($rest:ident)*]
        $($section:literal $Rate:ident $rate:literal $rate_name:literal $Sync:ident $sync:literal $sync_name:literal
            $Shape:ident $shape:literal $shape_name:literal $Phase:ident $phase:literal $phase_name:literal
            $Fade:ident $fade:literal $fade_name:literal $Scope:ident $scope:literal $scope_name:literal;)*
    ) => {
        $next! { { $($before)* $(
    $section {
        $Rate $rate $rate_name, Hertz 0.01..40.0 = 5.0, Logarithmic, Smoothed(20), [],
            "How many times a second it goes round.";
        $Sync $sync $sync_name, Choice 0.0..9.0 = 0.0, Linear, Smoothed(0),
            [NoteValue],
            "Note value that one round lasts at the song's tempo, in place of the rate.";
        $Shape $shape $shape_name, Choice 0.0..5.0 = 0.0, Linear, Smoothed(0),
            [Shape],
            "How it moves; steps are a new random number each round, drift slides from one to the next.";
        $Phase $phase $phase_name, Percent 0.0..100.0 = 0.0, Linear, NextNote, fixed [],
            "Where in its round it starts.";
        $Fade $fade $fade_name, Seconds 0.0..10.0 = 0.0, Linear, NextNote, [],
            "Time from the strike in which it fades in.";
        $Scope $scope $scope_name, Choice 0.0..1.0 = 0.0, Linear, NextNote, [Scope],
            "Whether each note has one of its own, which starts with it, or all notes use one, whose rate routes cannot move.";
    })*
        } $($rest)* }
    };
}

pub(super) use lfo;
