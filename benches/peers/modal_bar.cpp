// 256 of the Synthesis ToolKit's ModalBar, which has four modes: 1,024 modes at 48 kHz, for so many seconds.
#include <ModalBar.h>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

int main(int, char** arguments) {
    const long seconds = std::atol(arguments[1]);
    stk::Stk::setSampleRate(48000);
    stk::Stk::setRawwavePath("/usr/share/stk/rawwaves/");
    std::vector<std::unique_ptr<stk::ModalBar>> bars;
    for (int bar = 0; bar < 256; bar++) {
        bars.push_back(std::make_unique<stk::ModalBar>());
        bars.back()->setFrequency(100 + 10 * bar);
    }
    stk::StkFloat sum = 0;
    for (long frame = 0; frame < seconds * 48000; frame++) {
        // Struck again before anything has died away.
        if (frame % 12000 == 0) {
            for (auto& bar : bars) bar->strike(1.0);
        }
        for (auto& bar : bars) sum += bar->tick();
    }
    std::printf("%g\n", sum);
}
