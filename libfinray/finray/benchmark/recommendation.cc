#include "finray/benchmark/recommendation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace finray {
namespace {

// Errors that differ by less than this factor count as equal.
constexpr double kSameError = 1.02;
constexpr double kSameTime = 1.05, kFaster = 1.15, kExacter = 1.5, kCoarser = 2;
constexpr double kShareOfPeriod = 0.1;
// Iterations end at different places, so errors within this factor are equal.
constexpr double kSame = 2;
constexpr double kAsFast = 1.25;
constexpr double kMuchFaster = 0.8;
constexpr double kConfidence = 0.95;
// The ways of use in which the default is compared with the rest.
constexpr std::pair<const char*, const char*> kUses[] = {
    {"estimation", "block"},
    {"estimation", "live"},
    {"sensing", "surface"},
    {"sensing", "alone"}};
// Errors below this, in mm, N or rad, are equal.
constexpr double kNoError = 1e-9;

using Candidates = std::vector<const Measurement*>;

Candidates CandidatesFor(const std::vector<Measurement>& all,
                         const std::string& task, const std::string& how) {
  Candidates found;
  for (const Measurement& m : all) {
    if (m.name.task == task && m.name.scene == "one_contact" &&
        (how.empty() || m.name.how == how) && m.solved_percent == 100) {
      found.push_back(&m);
    }
  }
  return found;
}

double TimeOf(const Measurement& m) {
  return std::isnan(m.slow_frame_us) ? m.median_us() : m.slow_frame_us;
}

const Measurement* Fastest(const Candidates& candidates) {
  const auto found = std::min_element(
      candidates.begin(), candidates.end(),
      [](const auto* a, const auto* b) { return a->ratio() < b->ratio(); });
  return found == candidates.end() ? nullptr : *found;
}

const Measurement* DefaultOf(const Candidates& candidates) {
  const auto found =
      std::find_if(candidates.begin(), candidates.end(),
                   [](const auto* m) { return m->name.solver == "default"; });
  return found == candidates.end() ? nullptr : *found;
}

// Returns the fastest candidate with no error above kSame times the least, or
// the default if it is one of them and about as fast: measured times are noisy,
// and the default refines its mesh under high loads, which no other scheme
// does.
const Measurement* MostAccurate(const Candidates& candidates) {
  Candidates best = candidates;
  for (const ComparedError& compared : kComparedErrors) {
    const auto error = [&](const Measurement* m) {
      return m->errors.*compared.value;
    };
    double least = std::numeric_limits<double>::infinity();
    for (const Measurement* m : candidates) {
      least = std::min(least, std::max(error(m), kNoError));
    }
    best.erase(
        std::remove_if(best.begin(), best.end(),
                       [&](const auto* m) { return error(m) > kSame * least; }),
        best.end());
  }
  const Measurement *fastest = Fastest(best), *ours = DefaultOf(best);
  return ours != nullptr && ours->ratio() < kAsFast * fastest->ratio()
             ? ours
             : fastest;
}

// Returns those whose errors are small against the noise, but for those that
// another one dominates: a coarser one that is hardly faster.
Candidates Enough(const Candidates& candidates, const NoiseFloor& floor) {
  Candidates enough;
  for (const Measurement* m : candidates) {
    if (m->errors.contact_rms_mm() <= kShareOfNoise * floor.contact_mm &&
        m->errors.normal_rms_N() <= kShareOfNoise * floor.normal_N) {
      enough.push_back(m);
    }
  }
  Candidates best;
  for (const Measurement* m : enough) {
    if (std::none_of(enough.begin(), enough.end(), [m](const auto* other) {
          return Dominates(*other, *m, other->ratio() / m->ratio());
        })) {
      best.push_back(m);
    }
  }
  return best;
}

Recommendation Made(const char* use, const char* why, double limit_us,
                    const Measurement* m) {
  if (m == nullptr) return {use, why, limit_us, "", kNaN, kNaN};
  return {use, why, limit_us, m->name.id(), TimeOf(*m), m->errors.contact_mm};
}

Recommendation ForRate(const char* use, double period_us,
                       const std::vector<Measurement>& all) {
  Candidates fast;
  for (const Measurement* m : CandidatesFor(all, "estimation", "live")) {
    if (TimeOf(*m) <= kShareOfPeriod * period_us) fast.push_back(m);
  }
  return Made(use,
              "the most accurate live estimate in a tenth of the period, of "
              "equal ones the fastest",
              period_us, MostAccurate(fast));
}

DefaultCheck CheckDefault(const Measurement& ours,
                          const Candidates& candidates) {
  DefaultCheck check;
  check.id = ours.name.id();
  for (const Measurement* other : candidates) {
    if (other == &ours) continue;
    const std::string id = other->name.id();
    const double ratio = other->ratio() / ours.ratio();
    const Interval interval = RatioOfQuantiles(
        ours.ratios(), other->ratios(), Measurement::kUndisturbed, kConfidence);
    // The longest time that the interval leaves must dominate too.
    if (Dominates(*other, ours, interval.high)) {
      check.dominated_by.push_back(id);
    }
    if (interval.high < kMuchFaster &&
        kSameError * other->error() < ours.error()) {
      check.better.push_back(id);
    }
    if (other->error() <= kSame * ours.error() &&
        (check.rival.empty() || ratio < check.rival_time)) {
      check.rival = id;
      check.rival_time = ratio;
      check.rival_interval = interval;
    }
  }
  return check;
}

}  // namespace

bool Dominates(const Measurement& a, const Measurement& b, double time_ratio) {
  if (time_ratio > kSameTime || a.error() > kSameError * b.error()) {
    return false;
  }
  for (const ComparedError& error : kComparedErrors) {
    if (a.errors.*error.value >
        kCoarser * std::max(b.errors.*error.value, Measurement::kLeastError)) {
      return false;
    }
  }
  return kFaster * time_ratio < 1 || kExacter * a.error() < b.error();
}

std::vector<SceneFront> ParetoFronts(const std::vector<Measurement>& all) {
  std::vector<SceneFront> fronts;
  for (const Measurement& first : all) {
    SceneFront front{first.name.task, first.name.scene, {}};
    const auto belongs = [&](const auto& other) {
      return other.task == front.task && other.scene == front.scene;
    };
    if (std::any_of(fronts.begin(), fronts.end(), belongs)) continue;
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (belongs(all[i].name) && all[i].solved_percent == 100 &&
          !std::isnan(all[i].error())) {
        members.push_back(i);
      }
    }
    for (const std::size_t i : members) {
      if (std::none_of(members.begin(), members.end(), [&](std::size_t k) {
            return Dominates(all[k], all[i], all[k].ratio() / all[i].ratio());
          })) {
        front.front.push_back(i);
      }
    }
    std::sort(front.front.begin(), front.front.end(),
              [&](std::size_t i, std::size_t k) {
                return all[i].ratio() < all[k].ratio();
              });
    fronts.push_back(front);
  }
  return fronts;
}

std::vector<Recommendation> Recommend(const std::vector<Measurement>& all,
                                      const NoiseFloor& one_contact) {
  const Candidates batch =
      Enough(CandidatesFor(all, "estimation", "block"), one_contact);
  return {
      ForRate("30_Hz", 1e6 / 30, all), ForRate("1_kHz", 1e3, all),
      Made("batch",
           "the fastest estimate of logs whose errors of l_c and f_c (rms) are "
           "at most a quarter of the noise's",
           kNaN, Fastest(batch)),
      Made("reference", "the most accurate, of equal ones the fastest", kNaN,
           MostAccurate(CandidatesFor(all, "sensing", "")))};
}

std::vector<EnoughSetting> EnoughAgainstNoise(
    const std::vector<Measurement>& all, const NoiseFloor& one_contact) {
  std::vector<EnoughSetting> found;
  for (const auto& [task, how] : kUses) {
    const Candidates enough =
        Enough(CandidatesFor(all, task, how), one_contact);
    const Measurement *ours = DefaultOf(CandidatesFor(all, task, how)),
                      *fastest = Fastest(enough);
    if (ours == nullptr || fastest == nullptr) continue;
    found.push_back({ours->name.id(), fastest->name.id(), fastest->words,
                     fastest->errors.contact_rms_mm(),
                     fastest->errors.normal_rms_N(),
                     ours->ratio() / fastest->ratio(),
                     RatioOfQuantiles(fastest->ratios(), ours->ratios(),
                                      Measurement::kUndisturbed, kConfidence)});
  }
  return found;
}

std::vector<DefaultCheck> CheckDefaults(const std::vector<Measurement>& all) {
  std::vector<DefaultCheck> checks;
  for (const auto& [task, how] : kUses) {
    const Candidates candidates = CandidatesFor(all, task, how);
    const Measurement* ours = DefaultOf(candidates);
    if (ours != nullptr) checks.push_back(CheckDefault(*ours, candidates));
  }
  return checks;
}

}  // namespace finray
