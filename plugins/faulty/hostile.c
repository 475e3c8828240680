/* A planner for tests that attacks the console. The macro ATTACK contains the code of the attack, in C. One of these
 * macros determines when the attack happens:
 *  - IN_CONSTRUCTOR, IN_DESTRUCTOR, IN_CREATE, IN_DESTROY: in the function of that name;
 *  - IN_STEP: in the fourth step;
 *  - IN_THREAD: during the steps, in a thread that the constructor starts;
 *  - IN_LEFTOVER: within 40 ms after the fourth step, in a thread that this step leaves behind;
 *  - IN_ANSWER, IN_ANSWER_ALWAYS: on the answer `out` of the fourth step, or of every step. */
#define _GNU_SOURCE
#include "tankops_planner.h"
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-result"
#ifndef ATTACK
#define ATTACK
#endif
#ifndef CAPS
#define CAPS TP_CAP_LOCAL
#endif

/* Returns the path of a file in /proc that belongs to the console's process. */
static const char *of_parent(const char *what) {
  static char path[64];
  sprintf(path, "/proc/%d/%s", getppid(), what);
  return path;
}

static void rest(long milliseconds) {
  struct timespec time = {milliseconds / 1000, milliseconds % 1000 * 1000000};
  nanosleep(&time, NULL);
}

static void attack(void) {
#if !defined IN_ANSWER && !defined IN_ANSWER_ALWAYS
  ATTACK;
#endif
}

static void *some_time_later(void *nothing) {
  unsigned char random;
  if (getentropy(&random, 1) == 0) rest(random % 40);
  attack();
  for (;;) rest(1000);
  return nothing;
}

static void *later(void *nothing) {
  rest(100);
  attack();
  for (;;) rest(1000);
  return nothing;
}

#if defined IN_CONSTRUCTOR
__attribute__((constructor)) static void early(void) { attack(); }
#elif defined IN_THREAD
__attribute__((constructor)) static void early(void) {
  pthread_t thread;
  pthread_create(&thread, NULL, later, NULL);
}
#elif defined IN_DESTRUCTOR
__attribute__((destructor)) static void late(void) { attack(); }
#endif

static int n_steps;

static int32_t describe(const tp_host *h) { (void)h; return TP_OK; }
static int32_t create(const tp_host *h, const tp_site *s, const tp_value *v, uint32_t n, void **out) {
  (void)h; (void)s; (void)v; (void)n;
#ifdef IN_CREATE
  attack();
#endif
  *out = &n_steps;
  return TP_OK;
}
static void destroy(void *p) {
  (void)p;
#ifdef IN_DESTROY
  attack();
#endif
}
static int32_t plan(void *p, const tp_host *h, const tp_plan_in *in, tp_plan_out *out) {
  const tp_vec2 start = {in->start.x, in->start.y};
  (void)p;
  h->points(h->ctx, &start, 1);
  h->points(h->ctx, in->targets, in->n_targets);
  out->cost = 0.0; out->complete = 1;
  return TP_OK;
}
static int32_t step(void *p, const tp_host *h, const tp_step_in *in, tp_step_out *out) {
  (void)p; (void)h; (void)in;
  rest(5);
#ifdef IN_STEP
  if (n_steps == 3) attack();
#elif defined IN_LEFTOVER
  pthread_t thread;
  if (n_steps == 3) pthread_create(&thread, NULL, some_time_later, NULL);
#endif
  n_steps++;
  out->drive = TP_TWIST; out->status = TP_MOVING; out->a = 0.1; out->b = 0.0;
#ifdef IN_ANSWER
  if (n_steps == 4) { ATTACK; }
#elif defined IN_ANSWER_ALWAYS
  ATTACK;
#endif
  return TP_OK;
}
static const tp_planner planner = {
  sizeof(tp_planner), CAPS, 1, 0, TP_STR("hostile"), TP_STR("Attacker"), TP_STR("1"),
  TP_STR(""), describe, create, destroy, plan, step, 0, 0, 0, 0, 0};
static const tp_planner *const list[] = {&planner};
TP_EXPORT const tp_entry tank_planner_entry = TP_ENTRY(list, 1, "C");
TP_STAMP(TP_ABI_MAJOR, TP_ABI_MINOR);
