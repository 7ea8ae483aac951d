#!/bin/sh
# Clicks in the plugin's window as Windows has it, under Wine, and checks that the host hears the keys that nobody types there.
# On demand, not part of the suite: rustup target add x86_64-pc-windows-gnu
#   apt-get install gcc-mingw-w64-x86-64-posix g++-mingw-w64-x86-64-posix wine wine64 xvfb openbox libgl1-mesa-dri
#   cargo xtask patch; plugin/tests/windows.sh
set -eu
cd "$(dirname "$0")/../.."
target=x86_64-pc-windows-gnu
${CARGO:-cargo} rustc --manifest-path plugin/Cargo.toml --lib --crate-type cdylib --target $target -- -C strip=symbols
work=$(pwd)/target/wine
mkdir -p "$work"
x86_64-w64-mingw32-gcc -O1 -o "$work/host.exe" plugin/tests/windows/host.c
x86_64-w64-mingw32-gcc -O2 -shared -s -o "$work/bcryptprimitives.dll" plugin/tests/windows/bcryptprimitives.c -ladvapi32
export WINEPREFIX="$work/prefix" WINEDEBUG=-all DISPLAY=:79
Xvfb $DISPLAY -screen 0 1280x900x24 +extension GLX > "$work/xvfb.log" 2>&1 &
screen=$!
trap 'wineserver -k || true; kill $screen' EXIT
sleep 2
openbox > "$work/openbox.log" 2>&1 &
[ -e "$WINEPREFIX" ] || wine wineboot -i
# Where a real Windows and later versions of Wine have their own.
[ -e "$WINEPREFIX/drive_c/windows/system32/bcryptprimitives.dll" ] ||
    cp "$work/bcryptprimitives.dll" "$WINEPREFIX/drive_c/windows/system32/"
wine "$work/host.exe" "Z:$(pwd)/target/$target/debug/sprung_plugin.dll"
