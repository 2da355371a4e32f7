#include "finray/fit/calibration_errors.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "finray/io/nan.h"

namespace finray {

// CalibrationColumns of C: stiffness, rib lengths, kOwn for each gauge, then
// effects.
enum Own { kGain, kOffset, kCurvature, kStart, kLength, kFlat, kWidth, kOwn };

struct CalibrationColumns {
  int ribs, gauges, effects;

  int OfGauge(int gauge, int which) const {
    return 2 + ribs + kOwn * gauge + which;
  }
  int Effect() const { return OfGauge(gauges, 0); }
  int size() const { return Effect() + effects; }
};

namespace {

// How exact the gauges of the surface are, in std: std of contacts are off by
// as small a share.
constexpr double kSurfaceExact_std = 1e-4;

CalibrationColumns ColumnsOf(const SharedParameters& shared) {
  return {static_cast<int>(shared.rib_lengths_mm.size()),
          static_cast<int>(shared.gauge_starts_mm.size()),
          static_cast<int>(shared.effect_values.size())};
}

FrameFit::Shared SharedOf(const ModelSurface* surface,
                          FingerParameters* parameters) {
  SharedParameters& shared = *parameters->shared();
  const CalibrationColumns columns = ColumnsOf(shared);
  FrameFit::Shared of;
  of.parameters = &shared;
  of.columns = columns.size();
  of.surface = surface;
  of.column_of = {{&shared.ln_front_stiffness, 0},
                  {&shared.ln_back_stiffness, 1}};
  if (columns.ribs > 0) of.column_of.emplace(shared.rib_lengths_mm.data(), 2);
  for (int j = 0; j < columns.gauges; ++j) {
    double* const own[] = {
        parameters->gain(j),         parameters->offset(j),
        parameters->curvature(j),    &shared.gauge_starts_mm[j],
        &shared.gauge_lengths_mm[j], parameters->flat_share(j),
        parameters->ln_flat_width(j)};
    for (int k = 0; k < kOwn; ++k) {
      of.column_of.emplace(own[k], columns.OfGauge(j, k));
    }
  }
  if (columns.effects > 0) {
    of.column_of.emplace(shared.effect_values.data(), columns.Effect());
  }
  return of;
}

// The derivatives of the blocks' parameters by those of the calibration.
Eigen::MatrixXd ByCalibrated(const Finger& finger,
                             const CalibrationColumns& columns) {
  const auto& parameters = finger.calibration->parameters;
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(
      columns.size(), static_cast<Eigen::Index>(parameters.size()));
  int effect = columns.Effect();
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const auto [kind, index] = parameters[k];
    const auto set = [&, k](int row, double value) {
      by(row, static_cast<Eigen::Index>(k)) = value;
    };
    const auto set_own = [&, i = index](Own which, double value) {
      set(columns.OfGauge(i, which), value);
    };
    switch (kind) {
      case FingerParameterKind::kFrontStiffness:
        set(0, 1 / finger.front_stiffness_N_mm2);
        break;
      case FingerParameterKind::kBackStiffness:
        set(1, 1 / finger.back_stiffness_N_mm2);
        break;
      case FingerParameterKind::kRibLength:
        set(2 + index, 1);
        break;
      case FingerParameterKind::kGaugeGain:
        set_own(kGain, 1);
        break;
      case FingerParameterKind::kGaugeOffset:
        set_own(kOffset, 1);
        break;
      case FingerParameterKind::kGaugeCurvature:
        set_own(kCurvature, 1);
        break;
      case FingerParameterKind::kGaugeStart:
        set_own(kStart, 1);
        break;
      case FingerParameterKind::kGaugeLength:
        set_own(kLength, 1);
        break;
      case FingerParameterKind::kGaugeCreepShare: {
        const Gauge& gauge = finger.gauges[static_cast<std::size_t>(index)];
        set_own(kGain, gauge.gain_V_per_rad / (1 + gauge.creep_share));
        break;
      }
      case FingerParameterKind::kGaugeFlatShare:
        set_own(kFlat, 1);
        break;
      case FingerParameterKind::kGaugeFlatWidth:
        set_own(
            kWidth,
            1 / finger.gauges[static_cast<std::size_t>(index)].flat_width_rad);
        break;
      case FingerParameterKind::kGaugeCreepTime:
      case FingerParameterKind::kGaugeHysteresis:
        break;
      case FingerParameterKind::kHingeStiffness:
      case FingerParameterKind::kRibBending:
      case FingerParameterKind::kFrontPiece:
      case FingerParameterKind::kBackPiece:
      case FingerParameterKind::kFrontHinge:
      case FingerParameterKind::kBackHinge:
      case FingerParameterKind::kFrontClamp:
      case FingerParameterKind::kBackClamp:
      case FingerParameterKind::kBackAngle:
      case FingerParameterKind::kSurfaceOffset:
      case FingerParameterKind::kFriction:
        set(effect++, 1);
        break;
    }
  }
  return by;
}

const FrameFit::StartState kCold = [](const double*, LadderState* state) {
  state->q.resize(0);
};

}  // namespace

struct CalibrationErrors::Model {
  Model(const Finger& of, const Scene& in, const Discretization& by,
        bool calibrated, std::shared_ptr<const ModelSurface> with)
      : finger(of),
        scene(in),
        discretization(by),
        of_calibration(calibrated),
        surface(std::move(with)),
        frames(finger, scene, discretization),
        columns(ColumnsOf(*frames.parameters().shared())),
        linearizer(frames.solver(),
                   SharedOf(surface.get(), &frames.parameters())) {
    SetFactor();
  }

  void SetFactor() {
    by_calibrated = ByCalibrated(finger, columns);
    calibration_factor = finger.calibration->Factor();
    factor = by_calibrated * calibration_factor;
  }

  // The slope of a gauge where the frame is linearised, V/rad.
  double SlopeAt(int gauge) const {
    return finger.gauges[static_cast<std::size_t>(gauge)].Slope(
        frames.GaugeAngle(gauge));
  }

  Finger finger;
  Scene scene;
  Discretization discretization;
  bool of_calibration;  // the friction is that of the calibration
  std::shared_ptr<const ModelSurface> surface;
  RowFrames frames;
  CalibrationColumns columns;
  FrameFit linearizer;
  Eigen::MatrixXd by_calibrated, calibration_factor;
  Eigen::MatrixXd factor;  // F, by the columns of C
  LinearizedFrame at;
  using ByContacts =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
                    2 * kFittedContacts, Eigen::Dynamic>;
  ByContacts by_factor;  // dx/dp F
  // S at the contacts, the derivatives of x by the angles, and these times S.
  Eigen::MatrixXd discrepancy;
  ByContacts by_angle, by_discrepancy;
};

CalibrationErrors::CalibrationErrors(const Finger& any, const Scene& scene,
                                     const Discretization& discretization,
                                     Surface with_surface) {
  const Finger finger = ForFriction(any, scene.friction());
  if (!finger.calibration) return;
  std::shared_ptr<const ModelSurface> surface;
  if (with_surface == Surface::kMade) {
    RowFrames frames(finger, scene, discretization);
    ModelSurface::Content content{
        RowFrames::Resolution(finger, scene, kSurfaceExact_std)};
    surface = std::make_shared<const ModelSurface>(
        frames.solver(), *frames.parameters().shared(),
        scene.friction_coefficient, finger.calibration->HasGaugePlaces(),
        content);
  }
  model_ = std::make_unique<Model>(
      finger, scene, discretization,
      any.calibration &&
          IsFrictionOf(*any.calibration, scene.friction_coefficient),
      std::move(surface));
}

CalibrationErrors::CalibrationErrors(const CalibrationErrors& other) {
  if (other.empty()) return;
  const Model& m = *other.model_;
  model_ = std::make_unique<Model>(m.finger, m.scene, m.discretization,
                                   m.of_calibration, m.surface);
}

CalibrationErrors::~CalibrationErrors() = default;

void CalibrationErrors::SetErrors(const ParameterCovariance& calibration) {
  Model& m = *model_;
  m.finger.calibration = calibration;
  // The columns have the effects of the first calibration, so its friction
  // still decides whether the scene's counts as one of them.
  m.finger.calibration->friction =
      m.of_calibration ? m.scene.friction_coefficient : kNaN;
  m.finger = ForFriction(m.finger, m.scene.friction());
  m.SetFactor();
}

void CalibrationErrors::Prepare() const {
  if (!empty() && model_->surface) model_->surface->MakeAll();
}

const LinearizedFrame* CalibrationErrors::Linearize(
    const std::vector<PointContact>& contacts, const Measurements& row) {
  Model& m = *model_;
  m.frames.set_friction(contacts.empty() ? m.scene.friction_coefficient
                                         : contacts[0].friction);
  const FrameFit::Frame frame =
      m.frames.Of(row, contacts.data(), static_cast<int>(contacts.size()));
  return m.linearizer.Linearize(frame, kCold, &m.at) ? &m.at : nullptr;
}

Eigen::MatrixXd CalibrationErrors::ByParameter() const {
  return model_->at.by_parameter * model_->by_calibrated;
}

ContactMatrix CalibrationErrors::Of(const std::vector<PointContact>& contacts,
                                    const Measurements& row) {
  Model& m = *model_;
  const int unknowns = 2 * static_cast<int>(contacts.size());
  // Without a force a place makes no difference.
  const bool known =
      std::all_of(contacts.begin(), contacts.end(),
                  [](const PointContact& at) { return at.normal_N > 0; }) &&
      Linearize(contacts, row) != nullptr;
  ContactMatrix covariance(unknowns, unknowns);
  if (known) covariance = CovarianceOf(m.at.Information());
  if (!known || std::isinf(covariance(0, 0))) {
    covariance.setZero();
    covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return covariance;
  }
  m.at.Eliminate(covariance);
  m.by_factor.noalias() = m.at.move.by_parameter.lazyProduct(m.factor);
  covariance.noalias() = m.by_factor.lazyProduct(m.by_factor.transpose());
  if (contacts.size() == 1) FindWholeForce(contacts[0]);
  if (m.finger.calibration->discrepancy) {
    SetDiscrepancy(contacts);
    // A reading's error acts as its offset does, over the slope.
    m.by_angle.resize(unknowns, m.discrepancy.cols());
    for (Eigen::Index j = 0; j < m.by_angle.cols(); ++j) {
      const int gauge = static_cast<int>(j);
      m.by_angle.col(j) =
          m.SlopeAt(gauge) *
          m.at.move.by_parameter.col(m.columns.OfGauge(gauge, kOffset));
    }
    m.by_discrepancy.noalias() = m.by_angle.lazyProduct(m.discrepancy);
    const ContactMatrix missed =
        m.by_discrepancy.lazyProduct(m.by_angle.transpose());
    covariance += missed;
    if (contacts.size() == 1) {
      const double friction = contacts[0].friction;
      whole_force_variance_N2_ += (1 + friction * friction) * missed(1, 1);
    }
  }
  return covariance;
}

// dF = c df_c + f_c mu / c dmu with c = sqrt(1 + mu^2).
void CalibrationErrors::FindWholeForce(const PointContact& contact) {
  const Model& m = *model_;
  const double mu = contact.friction, per_normal = std::hypot(1, mu);
  const bool varies = m.finger.calibration->HasFriction();
  const Eigen::MatrixXd& factor = m.calibration_factor;
  whole_force_variance_N2_ = 0;
  for (Eigen::Index k = 0; k < factor.cols(); ++k) {
    double error = per_normal * m.by_factor(1, k);
    if (varies) {  // the last parameter
      error +=
          contact.normal_N * mu / per_normal * factor(factor.rows() - 1, k);
    }
    whole_force_variance_N2_ += error * error;
  }
}

double CalibrationErrors::Chi2(const std::vector<PointContact>& contacts,
                               const Measurements& row) {
  const LinearizedFrame* const at = Linearize(contacts, row);
  if (at == nullptr) return std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd error = at->by_parameter * model_->factor;
  const Eigen::Index rows = at->residuals.size();
  Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Identity(rows, rows) + error * error.transpose();
  if (model_->finger.calibration->discrepancy) {
    SetDiscrepancy(contacts);
    const Eigen::MatrixXd by_angle = ByAngle();
    covariance += by_angle * model_->discrepancy * by_angle.transpose();
  }
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::VectorXd whitened = root.matrixL().solve(at->residuals);
  if (contacts.empty()) return whitened.squaredNorm();
  const Eigen::MatrixXd slope =
      root.matrixL().solve(Eigen::MatrixXd(at->by_contact));
  return (whitened - slope * slope.colPivHouseholderQr().solve(whitened))
      .squaredNorm();
}

Eigen::MatrixXd CalibrationErrors::ByAngle() const {
  const Model& m = *model_;
  const auto gauges = static_cast<Eigen::Index>(m.finger.gauges.size());
  Eigen::MatrixXd by_angle =
      Eigen::MatrixXd::Zero(m.at.residuals.size(), gauges);
  for (std::size_t i = 0; i < m.at.rows.size(); ++i) {
    const int j = m.at.rows[i].gauge;
    if (j < 0) continue;
    const auto row = static_cast<Eigen::Index>(i);
    by_angle(row, j) =
        m.SlopeAt(j) * m.at.by_parameter(row, m.columns.OfGauge(j, kOffset));
  }
  return by_angle;
}

void CalibrationErrors::SetDiscrepancy(
    const std::vector<PointContact>& contacts) {
  const auto gauges = static_cast<Eigen::Index>(model_->finger.gauges.size());
  model_->discrepancy.setZero(gauges, gauges);
  for (const PointContact& contact : contacts) {
    model_->finger.calibration->discrepancy->AddTo(
        contact.arc_mm, contact.normal_N, &model_->discrepancy);
  }
}

}  // namespace finray
