#!/usr/bin/env python3
"""How long a host waits for the plugin: from opening the library to an instance that is activated at 48 kHz.

Each run is a process of its own, before which the library is thrown out of the system's file cache. For VST3, all
parameters are asked for as well, as hosts do when they load. Run after `cargo xtask bundle --release`; Linux only.
"""

import ctypes as c
import os
import subprocess
import sys
import time
from pathlib import Path

RUNS = 15
BUNDLED = Path(__file__).parents[2] / "target/bundled"
LIBRARIES = {
    "clap": BUNDLED / "Sprung.clap",
    "vst3": BUNDLED / f"Sprung.vst3/Contents/{os.uname().machine}-linux/Sprung.so",
}

def call(pointer, result, *arguments):
    """Calls a function by its address; arguments are given as ctypes values."""
    return c.CFUNCTYPE(result, *(type(argument) for argument in arguments))(pointer)(*arguments)

def words(address, count):
    """The pointers that lie at an address."""
    return (c.c_void_p * count).from_address(address)

def clap(path):
    library = c.CDLL(str(path))
    entry = c.addressof(c.c_char.in_dll(library, "clap_entry"))
    init, _, get_factory = words(entry + 16, 3)
    assert call(init, c.c_bool, c.c_char_p(str(path).encode()))
    factory = c.c_void_p(call(get_factory, c.c_void_p, c.c_char_p(b"clap.plugin-factory")))
    # A host that has nothing to offer: its version, five texts, and four functions that do nothing.
    nothing = c.CFUNCTYPE(c.c_void_p, c.c_void_p, c.c_void_p)(lambda *_: None)
    text = c.cast(c.c_char_p(b"load time"), c.c_void_p).value
    idle = c.cast(nothing, c.c_void_p).value
    host = (c.c_uint64 * 11)(1 | 1 << 32, 0, 0, text, text, text, text, idle, idle, idle, idle)
    descriptor = call(words(factory.value, 2)[1], c.c_void_p, factory, c.c_uint32(0))
    name = c.c_char_p(words(descriptor + 16, 1)[0])
    plugin = c.c_void_p(call(words(factory.value, 3)[2], c.c_void_p, factory, c.c_void_p(c.addressof(host)), name))
    functions = words(plugin.value, 5)
    assert call(functions[2], c.c_bool, plugin), "init"
    assert call(functions[4], c.c_bool, plugin, c.c_double(48000), c.c_uint32(1), c.c_uint32(512)), "activate"
    return nothing

def vst3(path):
    library = c.CDLL(str(path))
    assert library.ModuleEntry(c.c_void_p(library._handle))
    library.GetPluginFactory.restype = c.c_void_p
    factory = c.c_void_p(library.GetPluginFactory())

    def method(this, index, *arguments, result=c.c_int32):
        return call(words(words(this.value, 1)[0], index + 1)[index], result, this, *arguments)

    def byref(pointer):
        return c.cast(c.pointer(pointer), c.c_void_p)

    instance = c.c_void_p()
    component = bytes.fromhex("E831FF31F2D54301928EBBEE25697802")
    assert method(factory, 6, c.c_char_p(b"SprungMassSpring"), c.c_char_p(component), byref(instance)) == 0
    assert method(instance, 3, c.c_void_p()) == 0, "initialize"
    controller, processor = c.c_void_p(), c.c_void_p()
    for found, identifier in [
        (controller, "DCD7BBE37742448DA874AACC979C759E"),
        (processor, "42043F99B7DA453CA569E79D9AAEC33D"),
    ]:
        assert method(instance, 0, c.c_char_p(bytes.fromhex(identifier)), byref(found)) == 0, identifier
    info = c.create_string_buffer(2048)
    count = method(controller, 8)
    for index in range(count):
        assert method(controller, 9, c.c_int32(index), c.cast(info, c.c_void_p)) == 0, index
    # Real time, 32 bits, blocks of 512 frames at 48 kHz.
    setup = (c.c_int32 * 6)(0, 0, 512)
    c.c_double.from_address(c.addressof(setup) + 16).value = 48000
    assert method(processor, 7, c.c_void_p(c.addressof(setup))) == 0, "setupProcessing"
    assert method(instance, 11, c.c_uint8(1)) == 0, "setActive"

def run(kind):
    path = LIBRARIES[kind]
    file = os.open(path, os.O_RDONLY)
    os.fsync(file)
    os.posix_fadvise(file, 0, 0, os.POSIX_FADV_DONTNEED)
    os.close(file)
    start = time.perf_counter()
    keep = {"clap": clap, "vst3": vst3}[kind](path)
    print(1000 * (time.perf_counter() - start), flush=True)
    # What the instance holds goes with the process.
    os._exit(0 if keep is None or keep else 1)

if __name__ == "__main__":
    if len(sys.argv) > 1:
        run(sys.argv[1])
    for kind, path in LIBRARIES.items():
        times = sorted(
            float(subprocess.run([sys.executable, __file__, kind], check=True, capture_output=True, text=True).stdout)
            for _ in range(RUNS)
        )
        size = path.stat().st_size / 1e6
        print(f"{kind}: {size:.1f} MB, {times[RUNS // 2]:.0f} ms, at most {times[-1]:.0f} ms of {RUNS} runs")
