"""Opens the plugin's window in dawdreamer, as often as the second argument says; somebody else has to close it."""

import sys

import dawdreamer


def main():
    plugin, times = sys.argv[1], int(sys.argv[2])
    engine = dawdreamer.RenderEngine(48000, 512)
    synth = engine.make_plugin_processor("sprung", plugin)
    for _ in range(times):
        synth.open_editor()


main()
