// Sixteen voices of what Faust made of modes.dsp, in blocks of 64 frames at 48 kHz, for so many seconds.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#define FAUSTFLOAT float
struct Meta { void declare(const char*, const char*) {} };
struct UI {
    void openVerticalBox(const char*) {}
    void closeBox() {}
};
struct dsp {};
#include "modes.h"

int main(int, char** arguments) {
    const long seconds = std::atol(arguments[1]);
    std::vector<std::unique_ptr<mydsp>> voices;
    for (int voice = 0; voice < 16; voice++) {
        voices.push_back(std::make_unique<mydsp>());
        voices.back()->init(48000);
    }
    float input[64], output[64], sum = 0;
    float *inputs[] = {input}, *outputs[] = {output};
    uint32_t turn = 1;
    for (long block = 0; block < seconds * 48000 / 64; block++) {
        for (float& sample : input) {
            turn = turn * 1664525 + 1013904223;
            sample = turn * 0x1p-32f - 0.5f;
        }
        for (auto& voice : voices) {
            voice->compute(64, inputs, outputs);
            sum += output[63];
        }
    }
    std::printf("%g\n", sum);
}
