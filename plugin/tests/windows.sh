#!/bin/sh
# Opens the plugin's window as Windows has it, under Wine, twenty times, clicks in it, and checks that the host hears the keys that
# nobody types there. A step of `cargo xtask test --all`; `cargo xtask setup --all` installs what it needs. By hand:
#   cargo xtask patch; plugin/tests/windows.sh
set -eu
cd "$(dirname "$0")/../.."
target=x86_64-pc-windows-gnu
# The library that the tests in hosts have, so that it is not compiled a second time.
${CARGO:-cargo} test --manifest-path plugin/Cargo.toml --test hosts --no-run --target $target
# A prefix of its own: the first program in a prefix decides whether Windows has a screen there.
work=$(pwd)/target/wine
mkdir -p "$work"
x86_64-w64-mingw32-gcc -O1 -o "$work/host.exe" plugin/tests/windows/host.c
export WINEPREFIX="$work/screen" WINEDEBUG=-all WINEDLLOVERRIDES=winemenubuilder.exe=d DISPLAY=:79
Xvfb $DISPLAY -screen 0 1280x900x24 +extension GLX > "$work/xvfb.log" 2>&1 &
screen=$!
trap 'wineserver -k || true; kill $screen' EXIT
sleep 2
openbox > "$work/openbox.log" 2>&1 &
[ -e "$WINEPREFIX" ] || wine wineboot -i
# Where a real Windows and later versions of Wine have their own.
library=$WINEPREFIX/drive_c/windows/system32/bcryptprimitives.dll
[ -e "$library" ] ||
    x86_64-w64-mingw32-gcc -O2 -shared -s -o "$library" plugin/tests/windows/bcryptprimitives.c -ladvapi32
wine "$work/host.exe" "Z:$(pwd)/target/$target/debug/deps/sprung_plugin.dll"
