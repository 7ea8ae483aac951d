// The listing of "Harmonic oscillator, I turned jiggle physics code into a synthesizer" as written, behind a main()
// that reads "sampling_frequency frequency decay_frames amplitude frames sweep" lines and prints each sample's bits.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>

class HarmonicOscillator
{
public:
    void Initialise(float sampling_frequency, float frequency, float decay_frames, float amplitude);
    float Step();
    float StepWithSweep(float sweep);

private:
    float m_x, m_v, m_zeta, m_omega;
};

void HarmonicOscillator::Initialise(float sampling_frequency, float frequency, float decay_frames, float amplitude)
{
    m_omega = (frequency / sampling_frequency) * M_PI * 2.0f;
    m_zeta = 1.0f - expf(logf(0.001f) / decay_frames);

    m_x = 0.0f;
    m_v = m_omega * amplitude;

    m_zeta = m_zeta * 2.0f;
    m_omega = m_omega * m_omega;
}

float HarmonicOscillator::StepWithSweep(float sweep)
{
    m_v -= m_v * m_zeta + m_x * m_omega * sweep;
    m_x += m_v * sweep;
    return m_x;
}

float HarmonicOscillator::Step()
{
    m_v -= m_v * m_zeta + m_x * m_omega;
    m_x += m_v;
    return m_x;
}

int main()
{
    float sampling_frequency, frequency, decay_frames, amplitude, sweep;
    int frames;
    while (scanf("%f %f %f %f %d %f", &sampling_frequency, &frequency, &decay_frames, &amplitude, &frames, &sweep) == 6)
    {
        HarmonicOscillator oscillator;
        oscillator.Initialise(sampling_frequency, frequency, decay_frames, amplitude);
        for (int n = 0; n < frames; n++)
        {
            const float sample = sweep == 1.0f ? oscillator.Step() : oscillator.StepWithSweep(sweep);
            uint32_t bits;
            memcpy(&bits, &sample, sizeof bits);
            printf("%u\n", bits);
        }
    }
}
