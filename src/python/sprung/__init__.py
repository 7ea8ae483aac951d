"""A synthesizer whose only sound source is a mass on a spring.

>>> import sprung
>>> sound = sprung.render("Marimba", ["C4", "E4"], length=1)
>>> patch = sprung.Patch("Kick")
>>> patch.decay = "250 ms"
>>> kick = patch.render("C2", tail="none", length=0.5)

Names and values are those of the command: ``sprung help render``, ``sprung params``. The samples are the command's, bit for
bit. Errors are :class:`sprung.Error`, with the command's messages. The interpreter is free while sounds are made.
"""

from __future__ import annotations

import base64
import io
import os
import tempfile
import wave
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _sprung
from ._batch import batch
from ._sprung import Error, Locked, params, presets

__all__ = ["Error", "Locked", "Patch", "Sound", "analyze", "batch", "diff", "fit", "params", "presets", "render"]

#: A name or file of a preset or kit, or a patch.
PresetLike = Union[str, "os.PathLike[str]", "Patch"]
#: A note: a name (``"C#4"``), a key (``60``, ``60.5``) or a frequency (``"440Hz"``).
Note = Union[str, float, "np.integer[Any]", "np.floating[Any]"]
#: A file, an array of frames or of frames by channels at 48 kHz, or such an array and its rate.
SoundLike = Union[str, "os.PathLike[str]", npt.NDArray[Any], "tuple[npt.NDArray[Any], int]"]


class Sound(np.ndarray[Any, np.dtype[np.float32]]):
    """Samples as an array of frames by channels, ±1 being full scale, with their ``rate`` in Hz. A notebook plays it."""

    rate: int

    def __array_finalize__(self, source: Any) -> None:
        self.rate = getattr(source, "rate", 48_000)

    def __reduce__(self) -> Any:
        reduced: Any = super().__reduce__()
        make, arguments, state = reduced
        return make, arguments, (state, self.rate)

    def __setstate__(self, state: Any) -> None:
        super().__setstate__(state[0])
        self.rate = state[1]

    def save(self, path: str | os.PathLike[str], bits: int = 24) -> None:
        """Writes a WAV file of 16 or 24 bits."""
        Path(path).write_bytes(self.to_wav(bits))

    def to_wav(self, bits: int = 16) -> bytes:
        """The bytes of a WAV file of 16 or 24 bits."""
        if bits not in (16, 24):
            raise Error(f"bits: {bits}: expected 16 or 24")
        full_scale = float(1 << (bits - 1))
        frames = np.atleast_2d(np.asarray(self, dtype=np.float64).T).T
        samples = np.clip(np.rint(np.nan_to_num(frames) * full_scale), -full_scale, full_scale - 1).astype("<i4")
        with io.BytesIO() as out:
            with wave.open(out, "wb") as file:
                file.setnchannels(frames.shape[1])
                file.setsampwidth(bits // 8)
                file.setframerate(self.rate)
                parts = samples.reshape(-1, 1).view(np.uint8)[:, : bits // 8]
                file.writeframes(parts.tobytes())
            return out.getvalue()

    def _repr_html_(self) -> str:
        data = base64.b64encode(self.to_wav()).decode()
        return f'<audio controls src="data:audio/wav;base64,{data}"></audio>'


class Patch:
    """A preset to look at, change and play: ``patch.decay``, ``patch.decay = "250 ms"``.

    Parameters are attributes (``sprung.params()`` lists them). Numbers are in the parameter's unit, texts have a unit of
    their own, choices are texts. A notebook shows it with its C4 to play.
    """

    _native: _sprung.NativePatch

    def __init__(self, preset: PresetLike = "init") -> None:
        if isinstance(preset, Patch):
            native = _sprung.NativePatch.from_toml(preset.to_toml())
        else:
            native = _sprung.NativePatch(os.fspath(preset))
        object.__setattr__(self, "_native", native)

    @classmethod
    def from_toml(cls, text: str) -> Patch:
        """Reads the text of a preset file."""
        patch = cls.__new__(cls)
        object.__setattr__(patch, "_native", _sprung.NativePatch.from_toml(text))
        return patch

    def to_toml(self) -> str:
        """The text of a preset file, from which the same patch is read."""
        return self._native.to_toml()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a preset file."""
        Path(path).write_text(self.to_toml(), encoding="utf-8")

    @property
    def name(self) -> str:
        """The name."""
        return self._native.name

    @name.setter
    def name(self, name: str) -> None:
        self._native.name = name

    @property
    def comment(self) -> str:
        """What it is and how to play it."""
        return self._native.comment

    @property
    def modes(self) -> npt.NDArray[np.float64]:
        """The table of modes, a row each: ratio, level, decay, strike, pan."""
        return np.array(self._native.modes(), dtype=np.float64).reshape(-1, 5)

    def text(self, param: str) -> str:
        """A parameter with its unit: ``"250 ms"``."""
        return self._native.text(param)

    def render(self, notes: Note | Sequence[Note] | None = None, **options: Any) -> Sound:
        """As :func:`render`, with this patch."""
        return render(self, notes, **options)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return self._native.value(name)

    def __setattr__(self, name: str, value: Any) -> None:
        if isinstance(getattr(type(self), name, None), property):
            object.__setattr__(self, name, value)
        else:
            self._native.set(name, _text(value))

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(param["id"] for param in params())]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Patch) and self.to_toml() == other.to_toml()

    __hash__ = None  # type: ignore[assignment]

    def __copy__(self) -> Patch:
        return Patch(self)

    def __deepcopy__(self, memo: dict[int, Any]) -> Patch:
        return Patch(self)

    def __reduce__(self) -> tuple[Callable[[str], Patch], tuple[str]]:
        return Patch.from_toml, (self.to_toml(),)

    def __repr__(self) -> str:
        return f"<sprung.Patch ‘{self.name}’, {len(self.modes)} modes>"

    def _repr_html_(self) -> str:
        import html

        sound = self.render("C4", length=1.0, tail=1.0)
        return f"<b>{html.escape(self.name)}</b> C4<br>{sound._repr_html_()}"


def render(
    preset: PresetLike | None = None,
    notes: Note | Sequence[Note] | None = None,
    *,
    song: str | os.PathLike[str] | None = None,
    set: Mapping[str, Any] | None = None,
    channel: Mapping[int, PresetLike] | None = None,
    from_: float | str | None = None,
    to: float | str | None = None,
    pattern: int | None = None,
    **options: Any,
) -> Sound:
    """Renders notes, or a MIDI file, and gives its samples as 32-bit floats.

    ``from_`` and ``to`` are ``--from`` and ``--to``: a part of a song, in seconds (``90``) or bars (``"bar9.3"``); ``from`` is a
    word of Python's own, so it has an underscore. ``pattern`` is the pattern of a MIDI file of type 2, from 1.

    The other options are those of ``sprung render``: ``velocity``, ``length``, ``tail``, ``rate``, ``seed``, ``mono``,
    ``gain_db``, ``mix_gain_db``, ``normalize``, ``scale``, ``keymap``, ``input``, ``programs``, ``lenient``,
    ``tempo``, ``transpose``, ``solo``, ``mute``. Parameters stand in ``set``: ``set={"decay": "250 ms"}``.
    """
    for name, value, right in (("set", set, {"decay": "250 ms"}), ("channel", channel, {10: "Marimba"})):
        if value is not None and not isinstance(value, Mapping):
            raise Error(f"{name}: a {type(value).__name__}: expected a mapping, such as {right}")
    with ExitStack() as stack:
        given: dict[str, Any] = dict(options)
        if preset is not None:
            given["preset"] = _name(preset, stack)
        if notes is not None:
            given["note"] = notes
        given.update({"song": song, "from": from_, "to": to, "pattern": pattern})
        pairs = [(name, _text(value)) for name, value in given.items() if value is not None]
        pairs += [("set", f"{name}={_text(value)}") for name, value in (set or {}).items()]
        pairs += [("channel", f"{number}={_name(one, stack)}") for number, one in (channel or {}).items()]
        samples, rate = _sprung.render(pairs)
    sound = samples.view(Sound)
    sound.rate = rate
    return sound


def analyze(sound: SoundLike, *, most_modes: int = 256, all_strikes: bool = False) -> list[dict[str, Any]]:
    """Takes a recording apart: a dictionary for each strike, with the frequency, T60, level and phase of its ``modes``."""
    return _sprung.analyze(_sound(sound), most_modes, all_strikes)


def fit(
    sounds: SoundLike | list[SoundLike],
    *,
    note: Note | list[Note] | None = None,
    velocity: float | list[float] = 100,
    name: str = "Fitted",
    body: str = "table",
    most_modes: int = 192,
) -> Patch:
    """A patch that plays what was recorded: one note, or several of an instrument with their notes and velocities."""
    many: list[SoundLike] = sounds if isinstance(sounds, list) else [sounds]
    notes: list[Note | None] = [*note] if isinstance(note, list) else [note] * len(many)
    velocities: list[float] = velocity if isinstance(velocity, list) else [velocity] * len(many)
    if len(notes) != len(many) or len(velocities) != len(many):
        raise Error("note, velocity: expected one for each recording")
    takes = [
        (_sound(one), None if key is None else _text(key), float(hard))
        for one, key, hard in zip(many, notes, velocities)
    ]
    preset, _ = _sprung.fit(takes, name, body, most_modes)
    return Patch.from_toml(preset)


def diff(expected: SoundLike, actual: SoundLike) -> dict[str, Any] | None:
    """In what two sounds of one rate differ; ``None`` if they are the same, bit for bit."""
    return _sprung.diff(_sound(expected), _sound(actual))


def _text(value: Any) -> str:
    """A value as people write it."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple, np.ndarray)):
        return ",".join(_text(one) for one in value)
    if isinstance(value, float):
        return np.format_float_positional(value, trim="-") if np.isfinite(value) else str(value)
    return os.fspath(value) if isinstance(value, os.PathLike) else str(value)


def _name(preset: PresetLike, stack: ExitStack) -> str:
    """The name of a preset; a patch is written to a file that is there as long as the stack."""
    if not isinstance(preset, Patch):
        return os.fspath(preset)
    folder = stack.enter_context(tempfile.TemporaryDirectory())
    path = os.path.join(folder, "patch.toml")
    preset.save(path)
    return path


def _sound(sound: SoundLike) -> str | tuple[float, list[list[float]]]:
    """A sound as the native module takes it."""
    if isinstance(sound, (str, os.PathLike)):
        return os.fspath(sound)
    samples, rate = sound if isinstance(sound, tuple) else (sound, getattr(sound, "rate", 48_000))
    frames = np.asarray(samples)
    if frames.dtype.kind != "f" or frames.ndim not in (1, 2):
        what = f"{frames.dtype} of {frames.ndim} dimensions"
        raise Error(f"the array: {what}: expected floats within ±1, as frames or as frames by channels")
    frames = frames.astype(np.float32)
    channels = [frames] if frames.ndim == 1 else list(frames.T)
    return float(rate), [channel.tolist() for channel in channels]
