/* Texture plugin "uplift_texels" of Mitsuba 3, for the variant scalar_spectral: the spectra of padded texels.

   uplift.io.mitsuba passes all properties; `numbers` (1, height, width, C) has a border of `PADDING` texels. The same formulas
   as in uplift/io/mitsuba/texture.py and spectra.py, which tests compare. */

#include <mitsuba/core/properties.h>
#include <mitsuba/core/random.h>
#include <mitsuba/render/texture.h>
#include <drjit/tensor.h>
#include <sstream>

NAMESPACE_BEGIN(mitsuba)

template <typename Float, typename Spectrum>
class UpliftTexels final : public mitsuba::Texture<Float, Spectrum> {
public:
    MI_IMPORT_TYPES()
    using Base = mitsuba::Texture<Float, Spectrum>;
    using Values = UnpolarizedSpectrum;

    static constexpr int PADDING = 1;

    UpliftTexels(const Properties &props) : Base(props) {
        const TensorXf &numbers = props.get_any<TensorXf>("numbers");
        m_height = (int) numbers.shape(1), m_width = (int) numbers.shape(2), m_count = (int) numbers.shape(3);
        m_numbers.assign(numbers.array().data(), numbers.array().data() + numbers.array().size());
        std::istringstream to_uv{ std::string(props.get<std::string_view>("to_uv")) };
        for (float &each : m_to_uv)
            to_uv >> each;
        m_model = props.get<std::string_view>("model");
        m_filter = props.get<std::string_view>("filter");
        m_wrap = props.get<std::string_view>("wrap");
        m_warp = props.get<std::string_view>("warp");
        m_summary = props.get<std::string_view>("summary");
        m_start = props.get<float>("start"), m_end = props.get<float>("end");
        m_low = props.get<float>("low"), m_high = props.get<float>("high");
        m_mean = props.get<float>("mean");
    }

    Values eval(const SurfaceInteraction3f &si, Mask) const override {
        const float *t = m_to_uv;
        float u = t[0] * si.uv.x() + t[1] * si.uv.y() + t[2], v = t[3] * si.uv.x() + t[4] * si.uv.y() + t[5];
        float x = fold(u) * (m_width - 2 * PADDING) + PADDING, y = fold(v) * (m_height - 2 * PADDING) + PADDING;
        Values abscissa = map(si.wavelengths);
        if (m_filter == "bilinear") {
            x -= .5f, y -= .5f;
            float column = std::floor(x), row = std::floor(y), right = x - column, below = y - row;
            return (1 - right) * (1 - below) * spectrum(row, column, abscissa)
                 + right * (1 - below) * spectrum(row, column + 1, abscissa)
                 + (1 - right) * below * spectrum(row + 1, column, abscissa)
                 + right * below * spectrum(row + 1, column + 1, abscissa);
        }
        if (m_filter == "stochastic") {
            auto [first, second] = sample_tea_32(bits(si.uv.x()) ^ bits(si.wavelengths[0]), bits(si.uv.y()), 3);
            x += first * 0x1p-32f - .5f, y += second * 0x1p-32f - .5f;
        }
        return spectrum(std::floor(y), std::floor(x), abscissa);
    }

    Float mean() const override { return m_mean; }
    bool is_spatially_varying() const override { return true; }
    ScalarVector2i resolution() const override { return { m_width - 2 * PADDING, m_height - 2 * PADDING }; }
    std::string to_string() const override { return m_summary; }

    MI_DECLARE_CLASS(UpliftTexels)

private:
    static uint32_t bits(float number) { return dr::reinterpret_array<uint32_t>(number); }

    /// Fold a coordinate into [0, 1].
    float fold(float u) const {
        if (m_wrap == "clamp")
            return std::clamp(u, 0.f, 1.f);
        return m_wrap == "repeat" ? u - std::floor(u) : std::abs(u - 2 * std::nearbyint(u / 2));
    }

    /// What spectra are functions of: twice the cosine of the phase, [-1, 1], or the number of the sample.
    Values map(const Wavelength &wavelengths) const {
        Values clipped = dr::clip(wavelengths, m_start, m_end);
        if (m_model == "samples")
            return (clipped - m_start) * ((m_count - 1) / (m_end - m_start));
        if (m_model == "sigmoid")
            return (2 * clipped - (m_start + m_end)) / (m_end - m_start);
        Values warped = m_warp == "vision" ? dr::tanh(.0072f * (clipped - 538)) : clipped;
        return 2 * dr::cos(dr::Pi<float> * (warped - m_low) / (m_high - m_low) - dr::Pi<float>);
    }

    Values spectrum(float row, float column, const Values &x) const {
        size_t i = (size_t) std::clamp(row, 0.f, m_height - 1.f), j = (size_t) std::clamp(column, 0.f, m_width - 1.f);
        const float *numbers = m_numbers.data() + (i * m_width + j) * m_count;
        if (m_model == "samples")
            return interpolate(numbers, x);
        return m_model == "sigmoid" ? sigmoid((numbers[0] * x + numbers[1]) * x + numbers[2]) : moments(numbers, x);
    }

    Values interpolate(const float *samples, const Values &x) const {
        Values found;
        for (size_t k = 0; k < x.size(); ++k) {
            int first = std::min((int) x[k], m_count - 2);
            found[k] = samples[first] + (x[k] - first) * (samples[first + 1] - samples[first]);
        }
        return found;
    }

    static Values sigmoid(const Values &x) { return .5f + .5f * x * dr::rsqrt(1 + x * x); }

    /// x is twice the cosine of the phase.
    Values moments(const float *multipliers, const Values &x) const {
        Values linear = multipliers[0] + multipliers[1] * x, before = 2, cosine = x;
        for (int order = 2; order < m_count; ++order) {
            Values next = x * cosine - before;
            before = cosine, cosine = next;
            linear += multipliers[order] * cosine;
        }
        Values c = dr::rsqrt(1 + linear * linear), series = ARCTAN[7];
        for (int power = 6; power >= 0; --power)
            series = series * c + ARCTAN[power];
        return linear * c * series + .5f;
    }

    static constexpr float ARCTAN[] = { 0.49999966f, -0.318291775f, 0.249550106f, -0.207882832f,
                                        0.16639951f, -0.10996833f, 0.048598712f, -0.010096807f };

    std::vector<float> m_numbers;
    int m_height, m_width, m_count;
    float m_to_uv[6], m_start, m_end, m_low, m_high, m_mean;
    std::string m_model, m_filter, m_wrap, m_warp, m_summary;
};

using Scalar = UpliftTexels<float, Spectrum<float, 4>>;

extern "C" MI_EXPORT void init_plugin(std::string_view name, PluginRegisterFn fn) {
    fn(name, Scalar::Variant, ObjectType::Texture,
       [](void *, const Properties &props) -> ref<Object> { return new Scalar(props); });
}

NAMESPACE_END(mitsuba)
