/* A planner in C that turns to the target and drives there. It ignores obstacles. */
#include "tankops_planner.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

typedef struct {
  double speed;     /* cruise speed, m/s */
  double turn_gain; /* turn rate per radian of heading error, 1/s */
  double v_max, w_max;
  double tolerance; /* tolerance of the last plan, m */
} direct;

static int is_key(tp_str key, const char *name) {
  return key.len == strlen(name) && memcmp(key.ptr, name, key.len) == 0;
}

static double within(double value, double limit) { return fmax(-limit, fmin(limit, value)); }

static int32_t refuse(const tp_host *host, int32_t code, const char *sentence) {
  host->error(host->ctx, sentence, strlen(sentence));
  return code;
}

static int32_t describe(const tp_host *host) {
  const tp_param speed = {
      sizeof(tp_param), TP_PARAM_FLOAT, 0, 0,
      TP_STR("speed"), TP_STR("Cruise speed"), TP_STR("m/s"),
      TP_STR("Speed on the way to the target, at most the robot's own limit."), TP_STR("Drive"), TP_STR(""),
      0.01, 1.0, 0.2};
  const tp_param turn_gain = {
      sizeof(tp_param), TP_PARAM_FLOAT, TP_PARAM_LIVE, 0,
      TP_STR("turn_gain"), TP_STR("Turn gain"), TP_STR("1/s"),
      TP_STR("Turn rate per radian of heading error."), TP_STR("Drive"), TP_STR(""),
      0.1, 10.0, 2.0};
  host->param(host->ctx, &speed);
  host->param(host->ctx, &turn_gain);
  return TP_OK;
}

static void take(direct *self, const tp_value *values, uint32_t n) {
  for (uint32_t i = 0; i < n; i++) {
    if (is_key(values[i].key, "speed")) self->speed = values[i].number;
    if (is_key(values[i].key, "turn_gain")) self->turn_gain = values[i].number;
  }
}

static int32_t create(const tp_host *host, const tp_site *site, const tp_value *values, uint32_t n, void **instance) {
  direct *self = calloc(1, sizeof *self);
  if (!self) return refuse(host, TP_E_INTERNAL, "out of memory");
  self->v_max = site->v_max;
  self->w_max = site->w_max;
  self->tolerance = 0.05;
  take(self, values, n);
  *instance = self;
  return TP_OK;
}

static void destroy(void *instance) { free(instance); }

static int32_t reconfigure(void *instance, const tp_host *host, const tp_value *values, uint32_t n) {
  (void)host;
  take(instance, values, n);
  return TP_OK;
}

static int32_t plan(void *instance, const tp_host *host, const tp_plan_in *in, tp_plan_out *out) {
  direct *self = instance;
  if (in->task != TP_GOTO && in->task != TP_FOLLOW)
    return refuse(host, TP_E_UNSUPPORTED, "direct-c drives to points but does not cover floors");
  if (in->n_targets == 0) return refuse(host, TP_E_INVALID, "the task has no target");
  const tp_vec2 start = {in->start.x, in->start.y};
  host->points(host->ctx, &start, 1);
  host->points(host->ctx, in->targets, in->n_targets);
  double length = hypot(in->targets[0].x - start.x, in->targets[0].y - start.y);
  for (uint32_t i = 1; i < in->n_targets; i++)
    length += hypot(in->targets[i].x - in->targets[i - 1].x, in->targets[i].y - in->targets[i - 1].y);
  if (TP_HOST_HAS(host, legs)) { /* a console of ABI 1.0 does not accept legs */
    const tp_leg way = {TP_LEG_TRAVEL, 0, in->n_targets, 0};
    host->legs(host->ctx, &way, 1);
  }
  self->tolerance = in->tolerance;
  out->cost = length;
  out->complete = 1;
  return TP_OK;
}

static int32_t step(void *instance, const tp_host *host, const tp_step_in *in, tp_step_out *out) {
  const direct *self = instance;
  const double dx = in->target.x - in->pose.x, dy = in->target.y - in->pose.y;
  const double distance = hypot(dx, dy);
  const int is_last = in->n_targets_ahead <= 1;
  out->drive = TP_TWIST;
  if (is_last && distance < self->tolerance) {
    out->a = out->b = 0.0;
    out->status = TP_ARRIVED;
    return TP_OK;
  }
  const double error = remainder(atan2(dy, dx) - in->pose.heading, 2.0 * PI);
  const double speed = fmin(fmin(self->speed, self->v_max), is_last ? distance : HUGE_VAL);
  out->a = speed * fmax(0.0, cos(error));
  out->b = within(self->turn_gain * error, self->w_max);
  out->status = TP_MOVING;
  if (host->wants_drawing(host->ctx)) {
    const tp_draw arrow = {TP_DRAW_ARROW, TP_LAYER_ATTRACTION, {in->pose.x, in->pose.y}, {dx, dy}, 0.0};
    host->draw(host->ctx, &arrow, 1);
  }
  const tp_str name = TP_STR("heading_error"), unit = TP_STR("rad");
  host->scalar(host->ctx, name, error, unit);
  return TP_OK;
}

static const tp_planner direct_planner = {
    sizeof(tp_planner), TP_CAP_LOCAL | TP_CAP_LIVE_PARAMS, 1, 0,
    TP_STR("direct-c"), TP_STR("Straight to the target, in C"), TP_STR("0.1.0"),
    TP_STR("Turns to the target and drives there; ignores obstacles."),
    describe, create, destroy, plan, step, reconfigure, NULL, NULL, NULL, NULL};

static const tp_planner *const planners[] = {&direct_planner};

TP_EXPORT const tp_entry tank_planner_entry = TP_ENTRY(planners, 1, "C");
TP_STAMP(TP_ABI_MAJOR, TP_ABI_MINOR);
