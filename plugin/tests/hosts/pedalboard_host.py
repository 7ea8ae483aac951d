"""Does in pedalboard what standard input says, a JSON list of commands, each a list with its arguments. Writes their results, as JSON."""

import json
import re
import sys

import numpy
import pedalboard._pedalboard
from pedalboard import AudioProcessorParameter, VST3Plugin


def load(plugin, preset=None, name="Sprung", unread=r"^MIDI Ch\. "):
    """Loads a plugin; parameters whose names match are not tried out."""
    # It would try out a thousand values of each when a plugin is loaded, and 2,080 stand for MIDI controllers.
    AudioProcessorParameter.__init__.__defaults__ = (1,)
    pedalboard._pedalboard.PARAMETER_NAME_REGEXES_TO_IGNORE = {re.compile(unread)}
    synth = VST3Plugin(plugin, plugin_name=name)
    if preset:
        # After a preset, the host goes on with the values that it knew before, and sets them when it resets the
        # plugin. A state makes it ask for the values.
        other = load(plugin, unread="")
        other.load_preset(preset)
        set_state(synth, other.raw_state)
    return synth


def set_state(synth, state):
    """As `synth.raw_state = state`, which would look for a parameter of this name among all first."""
    VST3Plugin.raw_state.__set__(synth, state)


def render(plugin, preset, messages, sample_rate, block, frames, audio, name="Sprung"):
    """Plays MIDI messages, each a frame and bytes; the samples go to a file, channel by channel."""
    synth = load(plugin, preset, name, unread="")
    timed = [(bytes(data), frame / sample_rate) for frame, data in messages]
    samples = synth(timed, (frames + 0.25) / sample_rate, sample_rate, num_channels=2, buffer_size=block)
    samples = numpy.ascontiguousarray(samples[:, :frames], dtype="float32")
    samples.tofile(audio)
    return list(samples.shape)


def effect(plugin, name, settings, incoming, sample_rate, block, audio):
    """Sends a file's samples, the same on both sides, through an effect whose parameters have these names and positions."""
    effect = load(plugin, name=name)
    for parameter in effect.parameters.values():
        parameter.raw_value = settings.get(parameter.name, parameter.raw_value)
    side = numpy.fromfile(incoming, dtype="float32")
    samples = effect(numpy.stack([side, side]), sample_rate, buffer_size=block)
    numpy.ascontiguousarray(samples, dtype="float32").tofile(audio)
    return list(samples.shape)


def parameters(plugin, positions):
    """Sets each parameter to each position: name, and (position, value, text) of each."""
    synth = load(plugin)
    rows = []
    for parameter in synth.parameters.values():
        tried = []
        for position in positions:
            parameter.raw_value = position
            tried.append([position, parameter.raw_value, parameter.string_value])
        rows.append([parameter.name, tried])
    return [rows, synth.name, synth.manufacturer_name, synth.version, synth.is_instrument, synth.category]


def state(plugin, preset):
    """Loads a preset, moves the state into another instance: its values, and whether its state is the same."""
    first = load(plugin, preset, unread="")
    second = load(plugin)
    set_state(second, first.raw_state)
    return [[parameter.raw_value for parameter in second.parameters.values()], first.raw_state == second.raw_state]


def main():
    commands = {"render": render, "effect": effect, "parameters": parameters, "state": state}
    print(json.dumps([commands[name](*arguments) for name, *arguments in json.load(sys.stdin)]))


main()
