#!/bin/sh
# Drives DAWs of Debian's without hands: Ardour with the VST3 bundle, state and outputs; Qtractor's scan of the CLAP.
# On demand, not part of the suite: apt-get install ardour qtractor; cargo xtask bundle; plugin/tests/daws.sh
set -eu
bundled=$(cd "$(dirname "$0")/../../target/bundled" && pwd)
scripts=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME="$work" LC_ALL=C.UTF-8
mkdir -p "$HOME/.vst3" "$HOME/.clap"
cp -r "$bundled/Sprung.vst3" "$HOME/.vst3/"
cp "$bundled/Sprung.clap" "$HOME/.clap/"
# Ardour takes a scan only if it is newer than the bundle.
find "$HOME/.vst3" -exec touch -d '1 hour ago' {} +

echo "── Qtractor's scan"
scan=$(find /usr/lib -name qtractor_plugin_scan | head -n 1)
echo "CLAP:$HOME/.clap/Sprung.clap" | QT_QPA_PLATFORM=offscreen timeout 60 "$scan" | tee "$work/qtractor"
grep -q '^CLAP|Sprung|0:2|1:0|' "$work/qtractor"

echo "── Ardour's scan"
library=$(ls -d /usr/lib/ardour[0-9]* | head -n 1)
LD_LIBRARY_PATH="$library" timeout 60 "$library/ardour-vst3-scanner" -f "$HOME/.vst3/Sprung.vst3"
ardour() {
    echo "── a session in Ardour: $1 $3"
    timeout 120 "$(ls /usr/bin/ardour*-lua | head -n 1)" "$scripts/daws.lua" "$@" 2>&1 | tee "$work/ardour"
    grep -q '^passed' "$work/ardour"
}
ardour make "$work/session" Sprung
ardour load "$work/session" Sprung
ardour outputs "$work/outputs" "Sprung Multi"
