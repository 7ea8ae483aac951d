#!/usr/bin/env bash
# Times other synthesizers on the work of Sprung's benches: 16 voices of 64 resonators at 48 kHz, on one core.
#
# Installs what is missing from Debian's archive if that needs no password. Prints a line a peer, with tabs between:
# name, version, instructions (avx2, native: all that the CPU has, or packaged: those of Debian's build), 10^9 modes x samples a second or "-", times real time or a remark.
# A time is the CPU's of a long run less that of a short one, so that starting up is not in it; the best of three.
set -u
here=$(cd "$(dirname "$0")" && pwd)
work="$here/../../target/peers"
mkdir -p "$work" && cd "$work" || exit 1

packages=(csound supercollider-server supercollider-language faust libstk-dev stk fluidsynth timgm6mb-soundfont g++)
soundfont=/usr/share/sounds/sf2/TimGM6mb.sf2

install() {
    local missing=() sudo=()
    for package in "${packages[@]}"; do
        dpkg -s "$package" >/dev/null 2>&1 || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return
    [ "$(id -u)" -eq 0 ] || sudo=(sudo -n)
    # One at a time: what cannot be had must not keep the others away.
    "${sudo[@]}" apt-get update >&2
    for package in "${missing[@]}"; do
        "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "$package" >&2 ||
            echo "$package is not to be had; install it with: sudo apt-get install $package" >&2
    done
}

version() { dpkg-query -W -f '${Version}' "$1" 2>/dev/null || echo -; }

# Seconds of CPU time that a command takes, the best of three; nothing if it fails.
best_of_three() {
    local best="" seconds TIMEFORMAT='%U %S'
    for _ in 1 2 3; do
        seconds=$({ time "$@" >"$work/log" 2>&1 || echo failed; } 2>&1)
        case $seconds in *failed*) return 1 ;; esac
        seconds=$(awk '{ print $1 + $2 }' <<<"$seconds")
        best=$(awk -v a="$seconds" -v b="${best:-$seconds}" 'BEGIN { print (a < b) ? a : b }')
    done
    echo "$best"
}

# peer NAME PACKAGE ISA MODES SECONDS COMMAND…: times `COMMAND… SECONDS` and `COMMAND… 3×SECONDS`. MODES may be `-`.
peer() {
    local name=$1 package=$2 isa=$3 modes=$4 seconds=$5 short long
    shift 5
    if ! short=$(best_of_three "$@" "$seconds") || ! long=$(best_of_three "$@" $((3 * seconds))); then
        printf '%s\t%s\t%s\t-\t%s\n' "$name" "$(version "$package")" "$isa" "does not run here: $(tail -n 1 "$work/log")"
        return
    fi
    awk -v name="$name" -v version="$(version "$package")" -v isa="$isa" -v modes="$modes" -v sound=$((2 * seconds)) \
        -v spent="$(awk -v a="$long" -v b="$short" 'BEGIN { print a - b }')" 'BEGIN {
            giga = (modes == "-") ? "-" : sprintf("%.3f", modes * 48000 * sound / spent / 1e9)
            printf "%s\t%s\t%s\t%s\t%.1f\n", name, version, isa, giga, sound / spent
        }'
}

# have PROGRAM NAME: whether it is there; else says so in its row.
have() {
    command -v "$1" >/dev/null && return
    printf '%s\t-\t-\t-\t%s\n' "$2" "$1 is not to be had here"
    return 1
}

csound_score() { # OPCODES-OF-ONE-VOICE SECONDS
    printf '<CsoundSynthesizer>\n<CsOptions>\n-n -d -m0\n</CsOptions>\n<CsInstruments>\nsr = 48000\nksmps = 64\n'
    printf 'nchnls = 1\n0dbfs = 1\ninstr 1\nain rand 0.001\n%s\nout asum\nendin\n</CsInstruments>\n<CsScore>\n' "$1"
    for _ in {1..16}; do printf 'i 1 0 %s\n' "$2"; done
    printf '</CsScore>\n</CsoundSynthesizer>\n'
}

csound_mode() {
    local lines="asum = 0"
    for m in {0..63}; do lines+=$'\n'"a$m mode ain, $((100 + 310 * m)), 1000"$'\n'"asum = asum + a$m"; done
    csound_score "$lines" "$1" >mode.csd && timeout 100 csound mode.csd
}

csound_resony() {
    csound_score 'asum resony ain, 100, 10, 64, 20000, 0' "$1" >resony.csd && timeout 100 csound resony.csd
}

klank() { timeout 100 scsynth -N "klank-$1.osc" _ klank.wav 48000 WAV int16 -o 1 -i 0; }

fluid() {
    # Sixteen notes of the synthesized strings, held: a format 0 file with 480 ticks a quarter note of half a second,
    # and a track of 3 + 16 x 4 + 6 + 15 x 4 + 4 bytes. It plays on as long as a note is held, so all are let go.
    local events='\x00\xc0\x30' ticks=$((960 * $1)) length note
    for note in {40..55}; do events+="\\x00\\x90\\x$(printf %x "$note")\\x64"; done
    length="\\x$(printf %x $((128 | ticks >> 14 & 127)))\\x$(printf %x $((128 | ticks >> 7 & 127)))\\x$(printf %x $((ticks & 127)))"
    events+="$length\\x80\\x28\\x00"
    for note in {41..55}; do events+="\\x00\\x80\\x$(printf %x "$note")\\x00"; done
    events+="\\x00\\xff\\x2f\\x00"
    printf 'MThd\x00\x00\x00\x06\x00\x00\x00\x01\x01\xe0MTrk\x00\x00\x00\x89'"$events" >fluid.mid
    timeout 100 fluidsynth -q -F fluid.wav -T wav -O s16 -r 48000 -R 0 -C 0 "$soundfont" fluid.mid
}

compiled() { timeout 100 "./$program" "$1"; }

install
echo "timing; this takes some minutes" >&2

have csound "Csound mode" && peer "Csound mode" csound packaged 1024 3 csound_mode
have csound "Csound resony" && peer "Csound resony" csound packaged 1024 3 csound_resony
if have sclang "SuperCollider Klank" && have scsynth "SuperCollider Klank"; then
    # Its browser, which is of no use here, does not start for root unless told so.
    QTWEBENGINE_DISABLE_SANDBOX=1 QT_QPA_PLATFORM=offscreen timeout 60 sclang "$here/klank.scd" "$work" >"$work/sclang.log" 2>&1
    peer "SuperCollider Klank" supercollider-server packaged 1024 10 klank
fi
if have faust "Faust pm.modeFilter" && have g++ "Faust pm.modeFilter"; then
    for target in native x86-64-v3; do
        for options in "" "-vec -vs 64" "-vec -lv 1 -vs 64"; do
            isa=${target/x86-64-v3/avx2}
            program=faust-$target${options// /}
            # shellcheck disable=SC2086 # options are words
            faust -lang cpp $options "$here/modes.dsp" -o modes.h 2>"$work/log" &&
                g++ -O3 -ffast-math -march=$target -I. "$here/faust.cpp" -o "$program" 2>"$work/log"
            peer "Faust pm.modeFilter ${options:-scalar}" faust "$isa" 1024 10 compiled
        done
    done
fi
program=modal_bar
g++ -O3 -march=native -I/usr/include/stk "$here/modal_bar.cpp" -lstk -o $program 2>"$work/log" || rm -f $program
peer "STK ModalBar" libstk-dev packaged 1024 1 compiled
have fluidsynth "FluidSynth, 16 notes" && peer "FluidSynth, 16 notes" fluidsynth packaged - 30 fluid
