//! Parameter rows of pitch: tuning, sweep, vibrato and glide.

macro_rules! pitch {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Pitch" {
        Tune "tune" "Tune", Semitones -48.0..48.0 = 0.0, Linear, Smoothed(10), [],
            "Transposition.";
        Fine "fine" "Fine tune", Cents -100.0..100.0 = 0.0, Linear, Smoothed(10), [],
            "Fine transposition.";
        Tuning "tuning" "Tuning A4", Hertz 400.0..480.0 = 440.0, Linear, NextNote, fixed [],
            "Frequency of A4.";
        KeyTrack "key_track" "Key tracking", Percent 0.0..100.0 = 100.0, Linear, NextNote, fixed [],
            "How far pitch follows the key, about C4; 0 % gives every key the pitch of C4.";
        Sweep "sweep" "Sweep", Semitones -60.0..60.0 = 0.0, Linear, NextNote, [],
            "Where the pitch starts, above or below the note.";
        SweepTime "sweep_time" "Sweep time", Seconds 0.001..10.0 = 0.1, Logarithmic, NextNote, [],
            "Time until the sweep has arrived at the note.";
        SweepCurve "sweep_curve" "Sweep curve", Percent -100.0..100.0 = 50.0, Linear, NextNote, [],
            "0 % is a straight line; above, the sweep falls fast and settles slowly; below, the reverse.";
        Vibrato "vibrato" "Vibrato", Cents 0.0..1200.0 = 0.0, Linear, Smoothed(20), [],
            "Vibrato depth, each way.";
        VibratoRate "vibrato_rate" "Vibrato rate", Hertz 0.05..20.0 = 5.0, Logarithmic, Smoothed(20), [],
            "Vibrato frequency.";
        VibratoDelay "vibrato_delay" "Vibrato delay", Seconds 0.0..5.0 = 0.0, Linear, NextNote, [],
            "Time over which the patch's own vibrato fades in; what routes add acts at once.";
        VibratoSync "vibrato_sync" "Vibrato sync", Choice 0.0..9.0 = 0.0, Linear, Smoothed(0),
            [NoteValue],
            "Note value that one vibrato lasts at the song's tempo, in place of the vibrato rate.";
        Glide "glide" "Glide", Seconds 0.0..10.0 = 0.0, Linear, NextNote, fixed [],
            "Time to slide from the note before, or that for each octave; 0 is off.";
        GlideWhen "glide_when" "Glide when", Choice 0.0..1.0 = 0.0, Linear, NextNote, [GlideWhen],
            "Slide to every note, or only to those that start while another key is down.";
        GlideBy "glide_by" "Glide by", Choice 0.0..1.0 = 0.0, Linear, NextNote, [GlideBy],
            "Every slide takes the glide's time, or each octave of it does.";
    }
        } $($rest)* }
    };
}

pub(super) use pitch;
