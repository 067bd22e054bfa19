// A lattice of spectra fitted as Tódová, "Constrained Spectral Uplifting", 2020, 3.1.3 describes: Ceres with numeric
// differences, growing from the middle, every point starting from a fitted neighbour's coefficients.
//
//   fit INPUT OUTPUT sigmoid|moments|multipliers COUNT ITERATIONS
//
// INPUT, text: number of wavelengths N, lattice dim; N wavelengths (nm); 3 x N sensor matrix; dim axis nodes.
// OUTPUT, binary: dim^3 x COUNT doubles, blue fastest. Standard output: one line of JSON.
// The models are those of docs/mathematics.md, 2 to 4.
#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr double kPi = 3.14159265358979323846;
// A solve ends here, and a point within it is fitted: half the sum of squares is then enough for |RGB| <= 1e-4.
constexpr double kThreshold = 1e-4;

enum class Unknowns { kSigmoid, kMoments, kMultipliers };

struct Scene {
  Unknowns unknowns;
  int iterations, samples = 0, dim = 0;
  std::vector<double> wavelengths, matrix, nodes;
  std::vector<double> basis;  // samples x count, what the multipliers weigh
};

template <int C>
using Numbers = std::array<double, C>;

// Multipliers of the bounded maximum-entropy spectrum with moments c (docs/mathematics.md, 4; real moments).
// False where c are not the moments of any reflectance.
template <int C>
bool Dual(const double* c, double* p) {
  using Complex = std::complex<double>;
  std::array<Complex, C> h, a, q, n;
  if (!(c[0] >= 0 && c[0] <= 1)) return false;
  h[0] = std::polar(1.0, kPi * (c[0] - 0.5));
  for (int l = 1; l < C; ++l) {
    Complex sum = 0;
    for (int j = 0; j < l; ++j) sum += double(l - j) * c[l - j] * h[j];
    h[l] = Complex(0, 2 * kPi / l) * sum;
  }
  a[0] = h[0].real();
  for (int l = 1; l < C; ++l) a[l] = 0.5 * h[l];
  if (!(a[0].real() > 0)) return false;
  q.fill(0);
  q[0] = 1.0 / a[0];
  for (int order = 1; order < C; ++order) {  // Levinson: T q = e0, one order more at a time
    Complex spill = 0;
    for (int j = 0; j < order; ++j) spill += a[order - j] * q[j];
    const double margin = 1 - std::norm(spill);
    if (!(margin > 0)) return false;
    const std::array<Complex, C> before = q;
    for (int j = 0; j <= order; ++j)
      q[j] = ((j < order ? before[j] : 0.0) - spill * (j > 0 ? std::conj(before[order - j]) : 0.0)) / margin;
  }
  for (int k = 0; k < C; ++k) {
    n[k] = 0;
    for (int j = 0; j <= k; ++j) n[k] += h[j] * q[k - j];
  }
  for (int l = 0; l < C; ++l) {
    Complex sum = 0;
    for (int k = 0; k + l < C; ++k) sum += n[k + l] * std::conj(q[k]);
    p[l] = (sum / (Complex(0, 1) * q[0])).real();
    if (!std::isfinite(p[l])) return false;
  }
  return true;
}

// Residuals: RGB of the spectrum minus the target.
template <int C>
struct Residual {
  const Scene& scene;
  Numbers<3> target;

  bool operator()(const double* x, double* residual) const {
    double p[C];
    if (scene.unknowns != Unknowns::kMoments) std::copy(x, x + C, p);
    else if (!Dual<C>(x, p)) return false;
    double rgb[3] = {0, 0, 0};
    const int samples = scene.samples;
    for (int i = 0; i < samples; ++i) {
      double t = 0;
      for (int j = 0; j < C; ++j) t += scene.basis[i * C + j] * p[j];
      const double g = scene.unknowns == Unknowns::kSigmoid ? 0.5 + t / (2 * std::sqrt(1 + t * t))
                                                            : 0.5 + std::atan(t) / kPi;
      for (int k = 0; k < 3; ++k) rgb[k] += scene.matrix[k * samples + i] * g;
    }
    for (int k = 0; k < 3; ++k) residual[k] = rgb[k] - target[k];
    return true;
  }
};

struct StopWhenFitted : ceres::IterationCallback {
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    return now.cost <= 0.5 * kThreshold * kThreshold ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                     : ceres::SOLVER_CONTINUE;
  }
};

template <int C>
double Solve(const Scene& scene, const Numbers<3>& target, Numbers<C>& x) {
  const Residual<C> functor{scene, target};
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::NumericDiffCostFunction<Residual<C>, ceres::CENTRAL, 3, C>(
                               new Residual<C>(functor)), nullptr, x.data());
  StopWhenFitted stop;
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = scene.iterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  double residual[3];
  if (!functor(x.data(), residual)) return HUGE_VAL;
  return std::max({std::abs(residual[0]), std::abs(residual[1]), std::abs(residual[2])});
}

template <int C>
int Run(Scene& scene, const char* output) {
  const double first = scene.wavelengths.front(), last = scene.wavelengths.back();
  for (double wavelength : scene.wavelengths) {
    const double x = 2 * (wavelength - first) / (last - first) - 1, phase = kPi * (x - 1) / 2;
    for (int j = 0; j < C; ++j)
      scene.basis.push_back(scene.unknowns == Unknowns::kSigmoid ? std::pow(x, C - 1 - j)
                                                                 : (j ? 2 * std::cos(j * phase) : 1.0));
  }
  const int dim = scene.dim, size = dim * dim * dim, middle = (dim / 2 * dim + dim / 2) * dim + dim / 2;
  Numbers<C> grey{};  // of reflectance one half
  if (scene.unknowns == Unknowns::kMoments) grey[0] = 0.5;
  std::vector<Numbers<C>> found(size, grey);
  std::vector<double> distance(size, HUGE_VAL);
  std::deque<int> fitted;
  long solves = 0;
  auto attempt = [&](int index, Numbers<C> start) {
    const Numbers<3> target{scene.nodes[index / (dim * dim)], scene.nodes[index / dim % dim],
                            scene.nodes[index % dim]};
    const double off = Solve<C>(scene, target, start);
    ++solves;
    if (off < distance[index]) distance[index] = off, found[index] = start;
    if (off <= kThreshold) fitted.push_back(index);
  };
  const auto wall = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  attempt(middle, grey);
  while (!fitted.empty()) {
    const int from = fitted.front(), r = from / (dim * dim), g = from / dim % dim, b = from % dim;
    fitted.pop_front();
    for (int i = std::max(r - 1, 0); i <= std::min(r + 1, dim - 1); ++i)
      for (int j = std::max(g - 1, 0); j <= std::min(g + 1, dim - 1); ++j)
        for (int k = std::max(b - 1, 0); k <= std::min(b + 1, dim - 1); ++k) {
          const int to = (i * dim + j) * dim + k;
          if (distance[to] > kThreshold) attempt(to, found[from]);
        }
  }
  for (int index = 0; index < size; ++index)  // no fitted neighbour ever reached these
    if (distance[index] == HUGE_VAL) attempt(index, grey);
  const double cpu_seconds = double(std::clock() - cpu) / CLOCKS_PER_SEC;
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - wall;
  std::ofstream file(output, std::ios::binary);
  file.write(reinterpret_cast<const char*>(found.data()), size * sizeof(Numbers<C>));
  std::printf("{\"ceres\": \"%d.%d.%d\", \"solves\": %ld, \"cpu\": %.9f, \"wall\": %.9f}\n", CERES_VERSION_MAJOR,
              CERES_VERSION_MINOR, CERES_VERSION_REVISION, solves, cpu_seconds, seconds.count());
  return file.good() ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string model = argc == 6 ? argv[3] : "";
  Scene scene;
  if (model == "sigmoid") scene.unknowns = Unknowns::kSigmoid;
  else if (model == "moments") scene.unknowns = Unknowns::kMoments;
  else if (model == "multipliers") scene.unknowns = Unknowns::kMultipliers;
  else return std::cerr << "fit INPUT OUTPUT sigmoid|moments|multipliers COUNT ITERATIONS\n", EXIT_FAILURE;
  std::ifstream file(argv[1]);
  file >> scene.samples >> scene.dim;
  for (auto [values, count] : {std::pair{&scene.wavelengths, scene.samples},
                               std::pair{&scene.matrix, 3 * scene.samples}, std::pair{&scene.nodes, scene.dim}})
    for (double value; int(values->size()) < count && file >> value;) values->push_back(value);
  if (!file) return std::cerr << "bad input\n", EXIT_FAILURE;
  scene.iterations = std::atoi(argv[5]);
  switch (std::atoi(argv[4])) {
    case 3: return Run<3>(scene, argv[2]);
    case 5: return Run<5>(scene, argv[2]);
    case 9: return Run<9>(scene, argv[2]);
  }
  return std::cerr << "COUNT is 3, 5 or 9\n", EXIT_FAILURE;
}
