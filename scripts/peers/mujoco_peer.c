// Steps a finger in MuJoCo until it is at rest.
//
// mujoco_peer FOLDER MOST STILL reads FOLDER/chain.xml and FOLDER/loads.txt:
// the task, the numbers of front links, gauges and frames; what each gauge sums
// of the angles; a line a frame: contact, force, friction, and from there the
// next contact and force, or readings to sense. Writes FOLDER/angles.txt, as
// MuJoCo prints its warnings, a line a frame: seconds, steps, whether it is
// solved, contact, force, angles. mujoco_peer version prints MuJoCo's.
//
// Sensing is Gauss-Newton, its Jacobian by differences.
#include <math.h>
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { kSolve, kFollow, kSense };  // the task
enum { kMostGauges = 64, kMostSensing = 20 };

static const double kSoftness = 1e-4;

static mjModel* model;
static mjData* data;
static int front_links, gauges, most_steps, steps;
static double still, friction;
static double* shares;  // a row a gauge

static double Now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec + 1e-9 * now.tv_nsec;
}

// The force turns with its link.
static void Load(double contact, double force) {
  int body = 0;
  double joint = 0;
  while (body < front_links &&
         joint + model->body_pos[3 * (body + 1) + 1] < contact) {
    joint += model->body_pos[3 * ++body + 1];
  }
  const mjtNum* r = data->xmat + 9 * body;  // columns: normal, tangent, z
  const mjtNum none[3] = {0, 0, 0};
  mjtNum push[3] = {0, 0, 0}, point[3];
  for (int i = 0; i < 3; ++i) {
    push[i] = force * (r[3 * i] + friction * r[3 * i + 1]);
    point[i] = data->xpos[3 * body + i] + (contact - joint) * r[3 * i + 1];
  }
  mju_zero(data->qfrc_applied, model->nv);
  mj_applyFT(model, data, push, none, point, body, data->qfrc_applied);
}

// Steps from the state as it is; returns whether it came to rest.
static int Settle(double contact, double force) {
  mju_zero(data->qvel, model->nv);
  for (int k = 0; k < most_steps; ++k) {
    ++steps;
    mj_step1(model, data);
    Load(contact, force);
    mj_step2(model, data);
    for (int w = 0; w < mjNWARNING; ++w) {
      if (data->warning[w].number > 0) return 0;  // it diverged
    }
    double fastest = 0;
    for (int i = 0; i < model->nv; ++i) {
      fastest = fmax(fastest, fabs(data->qvel[i]));
    }
    // The rest is that of a geometric series.
    if (fastest * (1 + model->opt.timestep) < still) return 1;
  }
  return 0;
}

static void Read(double* readings) {
  mju_mulMatVec(readings, shares, data->qpos, gauges, model->nq);
}

static double Cost(const double* measured, double* misfit) {
  Read(misfit);
  for (int i = 0; i < gauges; ++i) misfit[i] = measured[i] - misfit[i];
  return mju_dot(misfit, misfit, gauges);
}

// Changes contact and force; returns whether it found them.
static int Sense(const double* measured, double* u) {
  const double h = 1e-3;
  double misfit[kMostGauges], beside[kMostGauges], slope[2][kMostGauges];
  int good = Settle(u[0], u[1]);
  double cost = Cost(measured, misfit);
  for (int k = 0; good && k < kMostSensing; ++k) {
    for (int j = 0; j < 2; ++j) {
      good &= Settle(u[0] + (j == 0 ? h : 0), u[1] + (j == 1 ? h : 0));
      Cost(measured, beside);
      for (int i = 0; i < gauges; ++i) {
        slope[j][i] = (misfit[i] - beside[i]) / h;
      }
    }
    const double a = mju_dot(slope[0], slope[0], gauges);
    const double b = mju_dot(slope[0], slope[1], gauges);
    const double c = mju_dot(slope[1], slope[1], gauges);
    const double d = mju_dot(slope[0], misfit, gauges);
    const double e = mju_dot(slope[1], misfit, gauges);
    double ds = (c * d - b * e) / (a * c - b * b);
    double df = (a * e - b * d) / (a * c - b * b);
    // Halved until it helps: links leave kinks.
    for (;; ds /= 2, df /= 2) {
      good &= Settle(u[0] + ds, u[1] + df);
      const double now = Cost(measured, beside);
      const int small = fmax(fabs(ds), fabs(df)) < 1e-5;
      if (now <= cost || small || !good) {
        u[0] += ds;
        u[1] += df;
        cost = now;
        mju_copy(misfit, beside, gauges);
        if (small) return good;
        break;
      }
    }
  }
  return 0;
}

int main(int argc, char** argv) {
  char path[4096], error[1000] = "";
  if (argc == 2) puts(mj_versionString());
  if (argc != 4) return argc != 2;
  snprintf(path, sizeof path, "%s/chain.xml", argv[1]);
  model = mj_loadXML(path, NULL, error, sizeof error);
  snprintf(path, sizeof path, "%s/loads.txt", argv[1]);
  FILE* loads = fopen(path, "r");
  snprintf(path, sizeof path, "%s/angles.txt", argv[1]);
  FILE* answers = fopen(path, "w");
  int task, frames;
  if (model == NULL || loads == NULL || answers == NULL ||
      fscanf(loads, "%d %d %d %d", &task, &front_links, &gauges, &frames) !=
          4 ||
      gauges > kMostGauges) {
    fprintf(stderr, "%s: %s\n", argv[1], error);
    return 1;
  }
  most_steps = atoi(argv[2]);
  still = atof(argv[3]);
  // Constraints are soft in proportion to this estimate of inertia.
  mju_scl(model->tendon_invweight0, model->tendon_invweight0, kSoftness,
          model->ntendon);
  mju_scl(model->body_invweight0, model->body_invweight0, kSoftness,
          2 * model->nbody);
  data = mj_makeData(model);
  shares = malloc(sizeof(double) * (gauges * model->nq + 1));
  for (int i = 0; i < gauges * model->nq; ++i) {
    if (fscanf(loads, "%lf", &shares[i]) != 1) return 1;
  }
  for (int k = 0; k < frames; ++k) {
    double u[2], next[kMostGauges];
    const int numbers = task == kSense ? gauges : 2;
    if (fscanf(loads, "%lf %lf %lf", &u[0], &u[1], &friction) != 3) return 1;
    for (int i = 0; i < numbers; ++i) {
      if (fscanf(loads, "%lf", &next[i]) != 1) return 1;
    }
    mj_resetData(model, data);
    double begin = Now();
    steps = 0;
    int good = Settle(u[0], u[1]);
    if (task != kSolve) {
      begin = Now();
      steps = 0;
      if (task == kFollow) mju_copy(u, next, 2);
      good &= task == kFollow ? Settle(u[0], u[1]) : Sense(next, u);
    }
    const double seconds = Now() - begin;
    fprintf(answers, "%.9g %d %d %.17g %.17g", seconds, steps, good, u[0],
            u[1]);
    for (int i = 0; i < model->nq; ++i)
      fprintf(answers, " %.17g", data->qpos[i]);
    fprintf(answers, "\n");
  }
  return fclose(answers) != 0;
}
