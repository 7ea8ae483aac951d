#!/usr/bin/env bash
# Times whole songs, Sprung beside FluidSynth: the demo songs, and ten from Debian's packages of free games.
#
# Installs what is missing from Debian's archive if that needs no password; the songs are unpacked into target/songs. Prints a
# line a song, with tabs between: its name, and the user seconds that Sprung and FluidSynth take on one thread.
# The two play in turn; each is the best of three.
set -euo pipefail
export LC_ALL=C
root=$(cd "$(dirname "$0")/.." && pwd)
sprung="$root/target/release/sprung"
soundfont=/usr/share/sounds/sf2/FluidR3_GM.sf2
mkdir -p "$root/target/songs" && cd "$root/target/songs"

sudo=()
[ "$(id -u)" -eq 0 ] || sudo=(sudo -n)
for package in fluidsynth fluid-soundfont-gm; do
    dpkg -s "$package" >/dev/null 2>&1 || "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes \
        --no-install-recommends "$package" >&2
done
for package in freedoom openttd-openmsx; do
    [ -d "$package" ] && continue
    apt-get download "$package" >&2
    dpkg-deb --extract "$package"_*.deb "$package.part" && mv "$package.part" "$package"
done

# A WAD has a directory of lumps: of 16 bytes each, offset, size and name.
python3 - freedoom/usr/share/games/doom/freedoom1.wad D_E1M1 D_E1M3 D_E1M8 D_E2M5 D_INTER <<'PYTHON'
import struct, sys
wad = open(sys.argv[1], "rb").read()
_, count, directory = struct.unpack_from("<4sII", wad)
for offset, size, name in struct.iter_unpack("<II8s", wad[directory : directory + 16 * count]):
    name = name.rstrip(b"\0").decode("ascii", "replace")
    if name in sys.argv[2:]:
        open(f"{name}.mid", "wb").write(wad[offset : offset + size])
PYTHON

# User seconds of a command.
user_seconds() {
    local TIMEFORMAT=%U
    { time "$@" >log 2>&1; } 2>&1 || { cat log >&2; exit 1; }
}

openmsx=openttd-openmsx/usr/share/games/openttd/baseset/openmsx
for song in "$root"/assets/midi/{groove,kits,suite}.mid D_{E1M1,E1M3,E1M8,E2M5,INTER}.mid \
    "$openmsx"/{flying_scotsman,midnight_snow_run,modern_motion,say_what_redfarn,wood_whistles}.mid; do
    for _ in 1 2 3; do
        user_seconds "$sprung" render "$song" --threads 1 --force -o sprung.wav | tr '\n' '\t'
        user_seconds fluidsynth -ni -r 48000 -F fluidsynth.wav "$soundfont" "$song"
    done | awk -v name="$(basename "$song" .mid)" '
        NR == 1 || $1 < a { a = $1 }
        NR == 1 || $2 < b { b = $2 }
        END { printf "%s\t%s\t%s\n", name, a, b }'
done
