/* tankops_planner.h - the interface for tankops planners in C11 and C++11.
 *
 * A planner is a shared library `libplanner_NAME.so` (`.dylib`, `planner_NAME.dll`) that exports one symbol:
 *
 *     static const tp_planner mine = { sizeof(tp_planner), TP_CAP_LOCAL, 1, 0, TP_STR("mine"), ... };
 *     static const tp_planner *const planners[] = { &mine };
 *     TP_EXPORT const tp_entry tank_planner_entry = TP_ENTRY(planners, 1, "gcc");
 *     TP_STAMP(TP_ABI_MAJOR, TP_ABI_MINOR);
 *
 * Rules
 *  - Neither side frees the other's memory. Inputs belong to the console and are valid only during the call. Results
 *    are passed to the console's functions in tp_host, which copy them before they return.
 *  - Functions return TP_OK or one of TP_E_...; before you return an error, call host->error with a sentence for the
 *    operator.
 *  - One instance is called from one thread, one call at a time. Call host->should_stop in every long loop.
 *  - No exception and no longjmp may leave a function.
 *  - Structs grow only at the end. `size` is the size of the struct as its writer knew it: read and write nothing
 *    beyond that size. Where an array has a stride, step by the stride and not by sizeof.
 *  - The planner runs in a separate process: a crash or an endless loop ends that process, not the console.
 *  - The planner may allocate up to 256 MB of memory (1 GB on coverage missions) and start up to 62 threads. Memory
 *    counts whether it is used or not. The stack of a thread counts in full: 8 MB unless its size is set with
 *    pthread_attr_setstacksize. Threads must end within the call that starts them.
 *
 * Units and frame: SI units; the tank frame has x east and y north; angles in radians, counter-clockwise from east.
 */
#ifndef TANKOPS_PLANNER_H
#define TANKOPS_PLANNER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#  define TP_ASSERT(what, text) static_assert(what, text)
#else
#  define TP_ASSERT(what, text) _Static_assert(what, text)
#endif

#define TP_ABI_MAJOR 1u /* the console refuses libraries with a different major version */
#define TP_ABI_MINOR 5u /* raised when something is added at the end of a struct */

/* ---- numbers that cross the boundary ------------------------------------------------------------------------- */

enum tp_code {
  TP_OK = 0,
  TP_E_INVALID = 1,        /* the request makes no sense */
  TP_E_CONFIG = 2,         /* the parameters contradict each other or do not fit the site */
  TP_E_START_OCCUPIED = 3,
  TP_E_START_OUTSIDE = 4,
  TP_E_GOAL_OCCUPIED = 5,
  TP_E_GOAL_OUTSIDE = 6,
  TP_E_NO_PATH = 7,        /* the points already passed to host->points are the part of the path that was found */
  TP_E_TIMEOUT = 8,        /* should_stop returned 2 */
  TP_E_CANCELLED = 9,      /* should_stop returned 1 */
  TP_E_STUCK = 10,         /* the planner is caught in a local minimum */
  TP_E_STATE = 11,         /* a function was called in the wrong order, or the state does not fit */
  TP_E_UNSUPPORTED = 12,   /* the planner does not offer this function or task */
  TP_E_INTERNAL = 13       /* an internal error of the planner; 14 and 15 are reserved */
};
enum tp_cap { TP_CAP_GLOBAL = 1, TP_CAP_LOCAL = 2, TP_CAP_COVERAGE = 4, TP_CAP_SNAPSHOT = 8, TP_CAP_LIVE_PARAMS = 16 };
enum tp_outline_kind { TP_DISC = 0, TP_POLYGON = 1, TP_POLYLINE = 2 };
enum tp_obstacle_flag { TP_DISCOVERED = 1 /* found during the mission: its position includes the position error */ };
enum tp_zone_kind { TP_ZONE_NO_GO = 0, TP_ZONE_LAND = 1, TP_ZONE_UNDERWATER = 2 };
enum tp_motion { TP_POINT = 0 /* moves in any direction */, TP_UNICYCLE = 1 /* drives forward and backward, and turns */ };
enum tp_reason {
  TP_REASON_START = 0, TP_REASON_BLOCKED = 1, TP_REASON_MAP_CHANGED = 2, TP_REASON_OPERATOR = 3,
  TP_REASON_SWAP = 4 /* `from` names the previous planner */, TP_REASON_RECOVER = 5
};
enum tp_task {
  TP_GOTO = 0,   /* one target */
  TP_FOLLOW = 1, /* targets in order */
  TP_COVER = 2   /* since 1.1: scan the regions and return to targets[0], the tether's anchor; requested only from
                    planners with TP_CAP_COVERAGE */
};
enum tp_status { TP_MOVING = 0, TP_ARRIVED = 1, TP_STUCK = 2, TP_WAITING = 3 };
enum tp_drive {
  TP_TWIST = 0,    /* a: forward speed, m/s; b: turn rate, rad/s */
  TP_VELOCITY = 1  /* a, b: velocity in the tank frame, m/s; the console turns the robot in this direction */
};
enum tp_param_kind {
  TP_PARAM_FLOAT = 0, TP_PARAM_INT = 1, TP_PARAM_FLAG = 2 /* 0 or 1 */, TP_PARAM_CHOICE = 3 /* index of the word */
};
enum tp_leg_tag { /* since 1.1 */
  TP_LEG_SWATH = 0,     /* the tool scans new floor */
  TP_LEG_CONNECTOR = 1, /* the robot drives from the end of one lane to the beginning of another */
  TP_LEG_RETRACT = 2,   /* the robot retraces its path so that the tether is reeled in */
  TP_LEG_TRAVEL = 3     /* the robot drives to the first lane, or home */
};
enum tp_param_flag { TP_PARAM_LIVE = 1 /* may change during a mission, by a call of reconfigure */ };
enum tp_draw_kind {
  TP_DRAW_ARROW = 0,  /* a: foot, b: vector from foot to tip */
  TP_DRAW_CIRCLE = 1, /* a: centre, value: radius */
  TP_DRAW_LINE = 2    /* a, b: ends */
};
enum tp_layer {
  TP_LAYER_ATTRACTION = 0, TP_LAYER_REPULSION = 1, TP_LAYER_ROTATION = 2, TP_LAYER_RESULTANT = 3,
  TP_LAYER_VIRTUAL = 4, TP_LAYER_PATH = 5, TP_LAYER_TETHER = 6, TP_LAYER_OTHER = 7
};
enum tp_log_level { TP_LOG_DEBUG = 0, TP_LOG_INFO = 1, TP_LOG_WARN = 2 };

/* ---- values; structs without a size are frozen for the major version ----------------------------------------- */

typedef struct tp_str { const char *ptr; size_t len; } tp_str; /* UTF-8, no terminating zero */
typedef struct tp_vec2 { double x, y; } tp_vec2;
typedef struct tp_pose { double x, y, heading; } tp_pose;
typedef struct tp_value { tp_str key; double number; } tp_value;
typedef struct tp_draw { uint32_t kind, layer; tp_vec2 a, b; double value; } tp_draw;
typedef struct tp_leg { uint32_t tag, first, last, reserved; } tp_leg; /* points first to last of the path, inclusive */
typedef struct tp_outline {
  uint32_t kind, n_points;
  const tp_vec2 *points; /* disc: its centre; polygon: corners counter-clockwise; polyline: its corners */
  double size_m;         /* disc: radius; polyline: half its thickness */
} tp_outline;
typedef struct tp_obstacle { /* may grow: use the stride */
  uint32_t id, flags;
  tp_outline outline;
  tp_vec2 velocity;      /* m/s, estimated; zero if it stands still or is not currently sensed (since 1.1) */
} tp_obstacle;
typedef struct tp_zone { uint32_t kind, reserved; tp_outline outline; } tp_zone;    /* may grow: use the stride */

/* ---- what the console passes --------------------------------------------------------------------------------- */

typedef struct tp_site {
  uint32_t size, revision;  /* revision increases whenever anything in this struct changes */
  uint64_t seed;            /* seed for all random choices, so that a plan can be reproduced */
  tp_outline boundary;      /* disc about the origin, or polygon */
  const tp_obstacle *obstacles;
  uint32_t n_obstacles, obstacle_stride;
  const tp_zone *zones;     /* where zones overlap, the later one applies */
  uint32_t n_zones, zone_stride;
  uint32_t motion, reserved;
  double v_max, w_max;      /* largest speed and turn rate of the robot */
  double radius;            /* radius of the smallest circle that encloses the robot */
  double sensing_range;     /* distance within which the robot senses obstacles */
  double swath;             /* lane spacing: the width scanned in one pass, less the overlap */
  double clearance;         /* distance to keep between the hull and anything solid */
  /* since 1.4 */
  double acceleration;      /* largest change of speed, m/s2; 0 if the console does not state it */
  double tick;              /* length of a tick, the time for which a command applies */
  uint32_t is_amphibious;   /* 1 for a robot that walks and swims: v_max and w_max are then the larger limits */
  uint32_t transition_ticks; /* time for a complete change from walking to swimming, ticks */
  double land_v_max, land_w_max;             /* on dry floor */
  double underwater_v_max, underwater_w_max; /* on flooded floor */
} tp_site;

typedef struct tp_plan_in {
  uint32_t size, reason;
  tp_str from;              /* with TP_REASON_SWAP: id of the previous planner */
  tp_pose start;
  double covariance[6];     /* of x, y, heading: xx xy xh yy yh hh */
  uint32_t task, n_targets;
  const tp_vec2 *targets;
  double tolerance;         /* the last target is reached when the robot is within this distance */
  const tp_vec2 *previous;  /* the path driven so far */
  uint32_t n_previous, reserved;
  const tp_site *site;
  /* since 1.1, with TP_COVER */
  const tp_outline *regions; /* floor still to be scanned: polygons; none means all reachable floor */
  uint32_t n_regions, has_tether; /* has_tether 0: no tether; its limits are infinite */
  double reel;              /* length of tether on the reel */
  double max_wrap;          /* largest wrap angle around one obstacle, radians */
  double max_sum_wrap;      /* largest sum of the wrap angles, radians */
  /* since 1.3, with TP_COVER: the plan to keep to as far as possible, such as the rest of the current plan */
  const tp_vec2 *way;       /* path of that plan; if it has no points, plan from scratch */
  const tp_leg *way_legs;
  uint32_t n_way, n_way_legs;
  const tp_outline *way_cuts; /* polylines */
  uint32_t n_way_cuts, way_complete;
  /* since 1.5, with TP_COVER: the pull at the reel that takes up the taut tether; newtons */
  double pull_per_m;        /* friction of the floor, newtons per metre of tether */
  double pull_friction;     /* round an obstacle, the pull grows by e^(pull_friction * wrap) */
  double reel_pull;         /* the console refuses a plan that needs more; 0 if the pull is not limited */
  double preferred_pull;    /* pull that a plan should not exceed */
} tp_plan_in;

typedef struct tp_step_in {
  uint32_t size, reserved;
  uint64_t tick;
  double t, dt;             /* mission time and length of a tick, seconds */
  tp_pose pose;
  double covariance[6];
  double v, w;              /* forward speed and turn rate that were last commanded */
  tp_vec2 target;           /* the point to go to next */
  const tp_vec2 *targets_ahead;
  uint32_t n_targets_ahead, n_path_ahead;
  const tp_vec2 *path_ahead;
  const tp_obstacle *obstacles; /* within the sensing range */
  uint32_t n_obstacles, obstacle_stride;
} tp_step_in;

/* ---- what the planner passes back ---------------------------------------------------------------------------- */

typedef struct tp_param {   /* pass it to host->param in describe */
  uint32_t size, kind, flags, reserved;
  tp_str key, label, unit, help, group;
  tp_str options;           /* words of a choice, joined by '|' */
  double min, max, def;
} tp_param;

typedef struct tp_plan_out { uint32_t size, complete; double cost; } tp_plan_out;
typedef struct tp_step_out { uint32_t size, status, drive, reserved; double a, b; } tp_step_out;

/* ---- functions of both sides --------------------------------------------------------------------------------- */

typedef struct tp_host {    /* the first argument is always host->ctx */
  uint32_t size, abi_minor; /* abi_minor of the console */
  void *ctx;
  uint32_t (*should_stop)(void *ctx);      /* 0 continue, 1 cancelled, 2 deadline passed; costs one clock read */
  double (*time_left_s)(void *ctx);
  uint32_t (*wants_drawing)(void *ctx);    /* 0 when drawings are not shown */
  void (*error)(void *ctx, const char *message, size_t len); /* the sentence that explains a refusal */
  void (*log)(void *ctx, uint32_t level, const char *message, size_t len);
  void (*param)(void *ctx, const tp_param *param);           /* in describe */
  void (*points)(void *ctx, const tp_vec2 *points, size_t n); /* in plan: the path, in one or more pieces */
  void (*draw)(void *ctx, const tp_draw *drawings, size_t n);
  void (*scalar)(void *ctx, tp_str name, double value, tp_str unit); /* a named figure for this tick */
  void (*bytes)(void *ctx, const uint8_t *bytes, size_t n);  /* in snapshot */
  /* since 1.1: check with TP_HOST_HAS first */
  void (*legs)(void *ctx, const tp_leg *legs, size_t n);     /* in plan: the purpose of each stretch, in order */
  void (*cut)(void *ctx, const tp_vec2 *points, size_t n);   /* in plan: one line that the robot must never cross */
  /* since 1.2: check with TP_HOST_HAS first */
  void (*progress)(void *ctx, double share, const char *what, size_t len); /* in plan: the share done, 0 to 1, and the
                    activity in a few words; shown while the plan is computed, and not stored. Call it freely. */
} tp_host;

typedef struct tp_planner { /* the first five functions are required; the others may be null */
  uint32_t size, caps, state_version, reserved;
  tp_str id;                /* stable, [a-z0-9_-]{1,32}: used in scenarios and recordings */
  tp_str name, version, about;
  int32_t (*describe)(const tp_host *);
  int32_t (*create)(const tp_host *, const tp_site *, const tp_value *values, uint32_t n, void **instance);
  void (*destroy)(void *instance); /* called when the mission no longer needs the instance: when the mission ends, when a
                    different planner or a new build takes over, and before the next instance is created in this
                    process. If this takes more than 0.1 s, the process is killed. A crash, a forbidden call or a
                    timeout here is reported but harms no mission. destroy is not called if the process was killed,
                    whether after a fault or together with the console. */
  int32_t (*plan)(void *instance, const tp_host *, const tp_plan_in *, tp_plan_out *);
  int32_t (*step)(void *instance, const tp_host *, const tp_step_in *, tp_step_out *);
  int32_t (*reconfigure)(void *instance, const tp_host *, const tp_value *values, uint32_t n);
  uint32_t (*stopping)(void *instance, const tp_host *); /* returns 1 to request a few more steps, otherwise 0 */
  int32_t (*snapshot)(void *instance, const tp_host *);
  int32_t (*restore)(void *instance, const tp_host *, uint32_t version, const uint8_t *state, size_t n);
  const void *(*get_extension)(tp_str name);
} tp_planner;

typedef struct tp_entry {
  uint8_t magic[8];
  uint32_t abi_major, abi_minor, size, n_planners;
  const tp_planner *const *planners;
  tp_str built_with;
} tp_entry;

typedef struct tp_stamp { uint8_t magic[8]; uint32_t abi_major, abi_minor; } tp_stamp;

/* ---- macros for a plugin ------------------------------------------------------------------------------------- */

#define TP_MAGIC { 'T', 'A', 'N', 'K', 'P', 'L', 'A', 'N' }
#define TP_HOST_HAS(host, member) \
  ((host)->size >= offsetof(tp_host, member) + sizeof((host)->member) && (host)->member)
#define TP_STR(literal) { literal, sizeof(literal) - 1 }
#define TP_ENTRY(list, n, compiler) \
  { TP_MAGIC, TP_ABI_MAJOR, TP_ABI_MINOR, sizeof(tp_entry), n, list, TP_STR(compiler) }

#ifdef __cplusplus
#  define TP_C extern "C"
#else
#  define TP_C
#endif

/* The console reads the stamp from the file before it loads the library, so no code of an incompatible library runs. */
#if defined(_MSC_VER)
#  define TP_EXPORT TP_C __declspec(dllexport)
#  pragma section(".tankpln", read)
#  define TP_STAMP(major, minor) TP_EXPORT __declspec(allocate(".tankpln")) \
     const tp_stamp tank_planner_stamp = { TP_MAGIC, major, minor }
#else
#  if defined(_WIN32)
#    define TP_SECTION ".tankpln"
#    define TP_VISIBLE __attribute__((dllexport))
#  elif defined(__APPLE__)
#    define TP_SECTION "__DATA,__tankplan"
#    define TP_VISIBLE __attribute__((visibility("default")))
#  else
#    define TP_SECTION ".tankplan"
#    define TP_VISIBLE __attribute__((visibility("default")))
#  endif
#  ifdef __cplusplus /* in C++ a const object is local to its file unless it was first declared extern */
#    define TP_EXPORT extern "C" TP_VISIBLE const tp_entry tank_planner_entry;
#    define TP_STAMP(major, minor) extern "C" TP_VISIBLE const tp_stamp tank_planner_stamp; \
       __attribute__((used, section(TP_SECTION))) \
       const tp_stamp tank_planner_stamp = { TP_MAGIC, major, minor }
#  else
#    define TP_EXPORT TP_VISIBLE
#    define TP_STAMP(major, minor) TP_VISIBLE __attribute__((used, section(TP_SECTION))) \
       const tp_stamp tank_planner_stamp = { TP_MAGIC, major, minor }
#  endif
#endif

/* The layout is the contract; the Rust side asserts the same numbers. */
TP_ASSERT(sizeof(void *) == 8, "tankops planners are 64-bit libraries");
TP_ASSERT(sizeof(tp_str) == 16 && sizeof(tp_vec2) == 16 && sizeof(tp_pose) == 24, "layout");
TP_ASSERT(sizeof(tp_outline) == 24 && sizeof(tp_obstacle) == 48 && sizeof(tp_zone) == 32, "layout");
TP_ASSERT(sizeof(tp_site) == 184 && offsetof(tp_site, boundary) == 16, "layout");
TP_ASSERT(offsetof(tp_site, obstacles) == 40 && offsetof(tp_site, zones) == 56, "layout");
TP_ASSERT(offsetof(tp_site, motion) == 72, "layout");
TP_ASSERT(sizeof(tp_plan_in) == 256 && offsetof(tp_plan_in, covariance) == 48, "layout");
TP_ASSERT(offsetof(tp_plan_in, targets) == 104 && offsetof(tp_plan_in, site) == 136, "layout");
TP_ASSERT(offsetof(tp_plan_in, regions) == 144 && offsetof(tp_plan_in, reel) == 160, "layout");
TP_ASSERT(offsetof(tp_plan_in, way) == 184 && offsetof(tp_plan_in, way_cuts) == 208, "layout");
TP_ASSERT(offsetof(tp_plan_in, pull_per_m) == 224 && offsetof(tp_plan_in, preferred_pull) == 248, "layout");
TP_ASSERT(sizeof(tp_step_in) == 176 && offsetof(tp_step_in, target) == 120, "layout");
TP_ASSERT(offsetof(tp_step_in, targets_ahead) == 136 && offsetof(tp_step_in, obstacles) == 160, "layout");
TP_ASSERT(sizeof(tp_plan_out) == 16 && sizeof(tp_step_out) == 32 && sizeof(tp_draw) == 48, "layout");
TP_ASSERT(sizeof(tp_param) == 136 && offsetof(tp_param, min) == 112 && sizeof(tp_value) == 24, "layout");
TP_ASSERT(sizeof(tp_host) == 120 && offsetof(tp_host, scalar) == 80 && offsetof(tp_host, legs) == 96, "layout");
TP_ASSERT(offsetof(tp_host, progress) == 112, "layout");
TP_ASSERT(sizeof(tp_leg) == 16, "layout");
TP_ASSERT(sizeof(tp_planner) == 160 && offsetof(tp_planner, describe) == 80, "layout");
TP_ASSERT(sizeof(tp_entry) == 48 && offsetof(tp_entry, planners) == 24 && sizeof(tp_stamp) == 16, "layout");

#ifdef __cplusplus
}
#endif
#endif /* TANKOPS_PLANNER_H */
