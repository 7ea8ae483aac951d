#!/usr/bin/env python3
"""Draws assets/play.png: `sprung play` in a terminal, while a chord of bells rings.

    sudo apt-get install tmux jackd2 fonts-hack && pip install pillow
    cargo build --release --features play && python3 assets/play.py

The sound goes to JACK's dummy driver, so no sound device is needed. tmux is the terminal; what it shows is painted with its colours.
"""

import re
import subprocess
import sys
import time
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).parents[1]
SPRUNG = ROOT / "target/release/sprung"
FONT = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/fonts/truetype/hack/Hack-Regular.ttf"
COLUMNS, ROWS, CELL, MARGIN = 100, 30, (10, 20), 8
FOREGROUND, BACKGROUND = (216, 218, 226), (22, 23, 29)
# The sixteen colours of a terminal, from black to bright white.
COLOURS = [
    (0, 0, 0), (205, 75, 75), (80, 180, 80), (226, 178, 64), (80, 130, 220), (180, 100, 200), (80, 180, 190), (216, 218, 226),
    (110, 112, 122), (240, 110, 110), (120, 220, 120), (250, 210, 100), (120, 170, 250), (220, 140, 240), (120, 220, 230), (255, 255, 255),
]  # fmt: skip


def tmux(*arguments):
    """Runs a command of a tmux server of our own, and returns what it prints."""
    return subprocess.run(["tmux", "-L", "sprung", *arguments], check=True, capture_output=True, text=True).stdout


def screen():
    """What the terminal shows while a chord rings: its lines, with escape sequences for colours."""
    jack = subprocess.Popen(
        ["jackd", "--no-realtime", "--name", "sprung", "-d", "dummy", "-r", "48000", "-p", "256"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        time.sleep(2)
        play = f"env JACK_DEFAULT_SERVER=sprung COLORTERM=truecolor {SPRUNG} play --host jack --midi-in none --preset 'Church Bell'"
        tmux("new-session", "-d", "-x", str(COLUMNS), "-y", str(ROWS), play)
        time.sleep(10)  # The messages of the start are gone then.
        for key in "zbe":
            tmux("send-keys", key)
        time.sleep(0.4)
        shown = tmux("capture-pane", "-e", "-p")
        tmux("send-keys", "C-c")
        time.sleep(2)
        return shown.split("\n")[:ROWS]
    finally:
        subprocess.run(["tmux", "-L", "sprung", "kill-server"], check=False, capture_output=True)
        jack.terminate()
        jack.wait()


def palette(numbers):
    """The colour at the start of the parameters after 38 or 48, which this takes from them."""
    if numbers.pop(0) == 2:
        return tuple(numbers.pop(0) for _ in range(3))
    index = numbers.pop(0)
    if index < 16:
        return COLOURS[index]
    if index >= 232:
        return (8 + 10 * (index - 232),) * 3
    return tuple(0 if level == 0 else 55 + 40 * level for level in ((index - 16) // 36, (index - 16) // 6 % 6, (index - 16) % 6))


def restyled(style, codes):
    """A style after an escape sequence `ESC [ codes m`."""
    numbers = [int(code or 0) for code in codes.replace(":", ";").split(";")]
    while numbers:
        number = numbers.pop(0)
        if number == 0:
            style = {}
        elif number in (1, 2, 7):
            style = {**style, {1: "bold", 2: "dim", 7: "reversed"}[number]: True}
        elif number in (38, 48):
            style = {**style, "ink" if number == 38 else "ground": palette(numbers)}
        elif number in (39, 49):
            style = {**style, "ink" if number == 39 else "ground": None}
        elif 30 <= number % 60 <= 37 or 40 <= number % 60 <= 47:
            bright = 8 if number >= 90 else 0
            style = {**style, "ink" if number % 10 == number % 60 - 30 else "ground": COLOURS[number % 10 + bright]}
    return style


def main():
    picture = Image.new("RGB", (COLUMNS * CELL[0] + 2 * MARGIN, ROWS * CELL[1] + 2 * MARGIN), BACKGROUND)
    draw, font = ImageDraw.Draw(picture), ImageFont.truetype(FONT, 16)
    style = {}
    for row, line in enumerate(screen()):
        column = 0
        for sequence, letter in re.findall(r"\x1b\[([0-9;:]*)m|(.)", line):
            if not letter:
                style = restyled(style, sequence)
                continue
            ink, ground = style.get("ink") or FOREGROUND, style.get("ground") or BACKGROUND
            if style.get("reversed"):
                ink, ground = ground, ink
            if style.get("dim"):
                ink = tuple((2 * part + other) // 3 for part, other in zip(ink, ground))
            left, top = MARGIN + column * CELL[0], MARGIN + row * CELL[1]
            draw.rectangle((left, top, left + CELL[0] - 1, top + CELL[1] - 1), fill=ground)
            draw.text((left, top), letter, font=font, fill=ink, stroke_width=0)
            column += 1
    picture.quantize(64).save(ROOT / "assets/play.png", optimize=True)


if __name__ == "__main__":
    main()
