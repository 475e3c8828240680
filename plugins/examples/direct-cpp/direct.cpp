// A planner in C++ that turns to the target and drives there. It ignores obstacles.
#include "tankops_planner.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>

namespace {

#define ID "direct-cpp"

struct Mine {
  double speed = 0.2;      // cruise speed, m/s
  double turn_gain = 2.0;  // turn rate per radian of heading error, 1/s
  double v_max, w_max;

  explicit Mine(const tp_site &site) : v_max(site.v_max), w_max(site.w_max) {}

  void take(const tp_value *values, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
      const std::string_view key(values[i].key.ptr, values[i].key.len);
      if (key == "speed") speed = values[i].number;
      if (key == "turn_gain") turn_gain = values[i].number;
    }
  }

  void drive(const tp_step_in &in, tp_step_out &out) const {
    const double dx = in.target.x - in.pose.x, dy = in.target.y - in.pose.y;
    const double error = std::remainder(std::atan2(dy, dx) - in.pose.heading, 2.0 * M_PI);
    out.drive = TP_TWIST;
    out.a = std::min({speed, v_max, std::hypot(dx, dy)}) * std::max(0.0, std::cos(error));
    out.b = std::clamp(turn_gain * error, -w_max, w_max);
    out.status = TP_MOVING;
  }
};

int32_t refuse(const tp_host *host, int32_t code, const char *sentence) {
  host->error(host->ctx, sentence, std::strlen(sentence));
  return code;
}

// No exception may leave a function that the console calls.
template <typename Call>
int32_t guarded(const tp_host *host, Call call) {
  try {
    return call();
  } catch (const std::exception &error) {
    return refuse(host, TP_E_INTERNAL, error.what());
  }
}

int32_t describe(const tp_host *host) {
  const tp_param params[] = {
      {sizeof(tp_param), TP_PARAM_FLOAT, TP_PARAM_LIVE, 0, TP_STR("speed"), TP_STR("Cruise speed"), TP_STR("m/s"),
       TP_STR("Speed on the way to the target."), TP_STR("Drive"), TP_STR(""), 0.01, 1.0, 0.2},
      {sizeof(tp_param), TP_PARAM_FLOAT, TP_PARAM_LIVE, 0, TP_STR("turn_gain"), TP_STR("Turn gain"), TP_STR("1/s"),
       TP_STR("Turn rate per radian of heading error."), TP_STR("Drive"), TP_STR(""), 0.1, 10.0, 2.0}};
  for (const tp_param &param : params) host->param(host->ctx, &param);
  return TP_OK;
}

int32_t create(const tp_host *host, const tp_site *site, const tp_value *values, uint32_t n, void **instance) {
  return guarded(host, [&] {
    auto *mine = new Mine(*site);
    mine->take(values, n);
    *instance = mine;
    return TP_OK;
  });
}

void destroy(void *instance) { delete static_cast<Mine *>(instance); }

int32_t plan(void *, const tp_host *host, const tp_plan_in *in, tp_plan_out *out) {
  if (in->task == TP_COVER) return refuse(host, TP_E_UNSUPPORTED, ID " does not cover floors");
  tp_vec2 last = {in->start.x, in->start.y};
  host->points(host->ctx, &last, 1);
  host->points(host->ctx, in->targets, in->n_targets);
  out->cost = 0.0;
  for (uint32_t i = 0; i < in->n_targets; last = in->targets[i++])
    out->cost += std::hypot(in->targets[i].x - last.x, in->targets[i].y - last.y);
  out->complete = 1;
  return TP_OK;
}

int32_t step(void *instance, const tp_host *host, const tp_step_in *in, tp_step_out *out) {
  return guarded(host, [&] {
    static_cast<const Mine *>(instance)->drive(*in, *out);
    return TP_OK;
  });
}

int32_t reconfigure(void *instance, const tp_host *, const tp_value *values, uint32_t n) {
  static_cast<Mine *>(instance)->take(values, n);
  return TP_OK;
}

const tp_planner mine = {
    sizeof(tp_planner), TP_CAP_LOCAL | TP_CAP_LIVE_PARAMS, 1, 0,
    TP_STR(ID), TP_STR("Straight to the target, in C++"), TP_STR("0.1.0"),
    TP_STR("Turns to the target and drives there; ignores obstacles."),
    describe, create, destroy, plan, step, reconfigure, nullptr, nullptr, nullptr, nullptr};

const tp_planner *const planners[] = {&mine};

}  // namespace

TP_EXPORT const tp_entry tank_planner_entry = TP_ENTRY(planners, 1, "C++");
TP_STAMP(TP_ABI_MAJOR, TP_ABI_MINOR);
