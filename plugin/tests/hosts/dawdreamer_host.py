"""Does in dawdreamer what standard input says, a JSON list of commands, each a list with its arguments. Writes their results, as JSON."""

import json
import sys

import dawdreamer
import numpy


def load(plugin, sample_rate=48000, block=512):
    engine = dawdreamer.RenderEngine(sample_rate, block)
    return engine, engine.make_plugin_processor("sprung", plugin)


def load_preset(synth, preset):
    if preset and not synth.load_vst3_preset(preset):
        sys.exit(f"{preset}: not loaded")


def render(plugin, preset, midi, sample_rate, block, frames, audio):
    """Plays a MIDI file; the samples go to a file, channel by channel."""
    engine, synth = load(plugin, sample_rate, block)
    load_preset(synth, preset)
    if not synth.load_midi(midi, clear_previous=True, beats=False, all_events=True):
        sys.exit(f"{midi}: not loaded")
    engine.load_graph([(synth, [])])
    engine.render((frames + 0.25) / sample_rate)
    samples = numpy.ascontiguousarray(engine.get_audio()[:, :frames], dtype="float32")
    samples.tofile(audio)
    return list(samples.shape)


def automate(plugin, preset, index, values, midi, sample_rate, frames, audio):
    """As render, with a parameter that takes a value a frame."""
    engine, synth = load(plugin, sample_rate, 512)
    load_preset(synth, preset)
    synth.load_midi(midi, clear_previous=True, beats=False, all_events=True)
    synth.set_automation(index, numpy.fromfile(values, dtype="float32"))
    engine.load_graph([(synth, [])])
    engine.render((frames + 0.25) / sample_rate)
    samples = numpy.ascontiguousarray(engine.get_audio()[:, :frames], dtype="float32")
    samples.tofile(audio)
    return list(samples.shape)


def parameters(plugin, positions):
    """Sets each parameter to each position: name, steps, automatable, and (position, value, text) of each."""
    engine, synth = load(plugin)
    described = synth.get_parameters_description()
    rows = []
    for parameter in described:
        if parameter["name"].startswith("MIDI Ch."):
            continue
        index = parameter["index"]
        tried = []
        for position in positions:
            synth.set_parameter(index, position)
            tried.append([position, synth.get_parameter(index), synth.get_parameter_text(index)])
        rows.append([parameter["name"], parameter["numSteps"], parameter["isAutomatable"], tried])
    return [rows, len(described), synth.get_latency_samples()]


def state(plugin, preset, first, second):
    """Loads a preset, saves the state, loads that into another instance, saves again; the other's values."""
    engine, synth = load(plugin)
    load_preset(synth, preset)
    synth.save_state(first)
    other_engine, other = load(plugin)
    other.load_state(first)
    other.save_state(second)
    return [other.get_parameter(index) for index in range(other.get_plugin_parameter_size())]


def main():
    commands = {"render": render, "automate": automate, "parameters": parameters, "state": state}
    print(json.dumps([commands[name](*arguments) for name, *arguments in json.load(sys.stdin)]))


main()
