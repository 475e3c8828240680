//! Planners that try to get more memory than they may have, in every known way: none gets much more.
#![cfg(target_os = "linux")]

use crate::desk::{Desk, ONE, opening, step};
use crate::stand::{config, folder_with};
use mission::planner::Parameters;
use mission::{Cause, Fault, Given};
use planner_host::HostConfig;
use std::time::Duration;

const HOSTILE: &str = include_str!("../../../../plugins/faulty/hostile.c");
const MB: u64 = 1 << 20;
/// The memory limit of planners in these tests, bytes.
const LIMIT: u64 = 64 * MB;
/// The memory that a worker may have in addition, bytes: libraries, its own memory, page tables, memory made read-only.
const BESIDE: u64 = 64 * MB;

/// Helper functions for the attacks.
const HELPERS: &str = r"
#define PRIVATE (MAP_PRIVATE | MAP_ANONYMOUS)
#define ONE_MB (1ul << 20)
static char *map(size_t n, int rights, int flags) {
  char *p = mmap(NULL, n, rights, flags, -1, 0);
  return p == MAP_FAILED ? NULL : p;
}
/* Writes to pieces of memory and then gives up these rights to them. */
static void hide(size_t n, int rights) {
  for (size_t i = 0; i < 1024 * ONE_MB / n; i++) {
    char *p = map(n, PROT_READ | PROT_WRITE, PRIVATE);
    if (!p) return;
    memset(p, 1, n);
    mprotect(p, n, rights);
  }
}
static void *hide_much(void *nothing) { hide(30 * ONE_MB, PROT_READ); return nothing; }
/* Takes address space until there is no more of it, and then writes to it. */
static void fill_space(size_t n) {
  char *pieces[4096]; int k = 0;
  while (k < 4096 && (pieces[k] = map(n, PROT_NONE, PRIVATE))) k++;
  while (k-- > 0) if (!mprotect(pieces[k], n, PROT_READ | PROT_WRITE)) memset(pieces[k], 1, n);
}
/* The same with one piece that grows. */
static void grow_space(void) {
  size_t n = 4096;
  char *p = map(n, PROT_NONE, PRIVATE);
  for (size_t step = 1ul << 40; step >= 4096; step /= 2) {
    char *moved = mremap(p, n, n + step, MREMAP_MAYMOVE);
    if (moved != MAP_FAILED) { p = moved; n += step; }
  }
  for (size_t at = 0; at + ONE_MB < n && at < 1024 * ONE_MB; at += ONE_MB)
    if (!mprotect(p + at, ONE_MB, PROT_READ | PROT_WRITE)) memset(p + at, 1, ONE_MB);
}
/* A page here and there, so that each has a table of its own. */
static void spread(void) {
  for (size_t i = 0; i < 60000; i++) {
    char *at = (char *)0x100000000000ul + i * 2 * ONE_MB;
    char *p = mmap(at, 4096, PROT_READ | PROT_WRITE, PRIVATE | MAP_FIXED, -1, 0);
    if (p == MAP_FAILED) return;
    *p = 1;
  }
}
/* Reads address space that holds nothing. */
static void read_nothing(size_t n) {
  volatile char sum = 0;
  for (int i = 0; i < 64; i++) {
    char *p = map(n, PROT_READ, PRIVATE);
    for (size_t at = 0; p && at < n; at += 2 * ONE_MB) sum += p[at];
  }
}
static int deep(int n) {
  volatile char frame[65536];
  memset((char *)frame, 1, sizeof frame);
  return n == 0 ? frame[7] : deep(n - 1) + frame[9];
}
static void *on_a_stack(void *nothing) {
  volatile char frame[30 << 20];
  memset((char *)frame, 1, sizeof frame);
  rest(200);
  return nothing;
}
static void many(void *(*work)(void *), size_t stack) {
  pthread_attr_t attributes; pthread_attr_init(&attributes); pthread_attr_setstacksize(&attributes, stack);
  pthread_t threads[60]; int k = 0;
  while (k < 60 && !pthread_create(&threads[k], &attributes, work, NULL)) k++;
  while (k-- > 0) pthread_join(threads[k], NULL);
}
static void of_heap(void) {
  for (int i = 0; i < 1024; i++) {
    char *p = sbrk(ONE_MB);
    if (p == (char *)-1) return;
    memset(p, 1, ONE_MB);
    mprotect((char *)(((size_t)p + 4095) & ~4095ul), ONE_MB - 4096, PROT_READ);
  }
}
static void move_along(void) {
  char *p = map(16 * ONE_MB, PROT_READ | PROT_WRITE, PRIVATE);
  for (int i = 0; p && i < 64; i++) {
    memset(p, 1, 16 * ONE_MB);
    char *moved = mremap(p, 16 * ONE_MB, 16 * ONE_MB, MREMAP_MAYMOVE | MREMAP_DONTUNMAP);
    if (moved == MAP_FAILED) return;
    mprotect(moved, 16 * ONE_MB, PROT_READ);
  }
}
static void of_file(void) {
  for (int i = 0; i < 65536; i++) {
    char *p = mmap(NULL, 16384, PROT_READ | PROT_WRITE, MAP_PRIVATE, 201, 0);
    if (p == MAP_FAILED) return;
    memset(p, 1, 4096);
    mprotect(p, 16384, PROT_READ);
  }
}
static void attack";

/// The peak memory of a worker whose planner carried out this attack, bytes, or the fault.
fn memory_of(moment: &str, attack: &str) -> Result<u64, Fault> {
    let source = HOSTILE.replacen("static void attack", HELPERS, 1);
    let (_folder, dirs) =
        folder_with("hostile", &format!("#define {moment}\n#define ATTACK {attack}\n{source}"));
    // On a busy machine, the attack may take long, but the memory limit must end the attack, not the deadline.
    let patient = Duration::from_mins(1);
    let config = HostConfig {
        memory_limit_bytes: LIMIT,
        configure_deadline: patient,
        step_deadline: patient,
        ..config()
    };
    let mut desk = Desk::new(&dirs, config);
    desk.ask(ONE, opening("hostile", &Parameters::new(), None))?;
    for tick in 0..5 {
        desk.ask(ONE, step(tick))?;
    }
    Ok(desk.host.memory(ONE).expect("it is there").most_bytes)
}

fn is_over(fault: &Fault) -> bool {
    fault.cause == Cause::Died && fault.message.contains("exceeded its memory limit of 64 MB")
}

#[test]
fn no_way_leads_to_more_memory_than_a_planner_may_have() {
    for attack in [
        "hide(ONE_MB, PROT_READ)",
        "hide(ONE_MB, PROT_NONE)",
        "hide(ONE_MB, PROT_EXEC)",
        "hide(64 * 1024, PROT_READ)",
        "hide(30 * ONE_MB, PROT_READ)",
        "many(hide_much, 65536)",
        "fill_space(200 * ONE_MB)",
        "fill_space(ONE_MB)",
        "grow_space()",
        "read_nothing(1024 * ONE_MB)",
        "read_nothing(1024 * 1024 * ONE_MB)",
        "many(on_a_stack, 32 * ONE_MB)",
        "of_heap()",
        "move_along()",
        "while (malloc(ONE_MB)) continue",
    ] {
        match memory_of("IN_STEP", attack) {
            Ok(most) => assert!(most < LIMIT + BESIDE, "{attack}: {} MB", most / MB),
            Err(fault) => assert!(is_over(&fault), "{attack}: {fault}"),
        }
    }
}

#[test]
fn what_the_system_does_not_count_is_weighed() {
    for attack in ["hide(16 * 1024, PROT_READ)", "spread()", "of_file()"] {
        for moment in ["IN_STEP", "IN_CREATE"] {
            let fault = memory_of(moment, attack).expect_err(attack);
            assert!(is_over(&fault), "{attack}: {fault}");
        }
    }
}

#[test]
fn locked_memory_is_forbidden_and_huge_pages_are_not_there() {
    let locked = memory_of("IN_STEP", "map(ONE_MB, PROT_READ | PROT_WRITE, PRIVATE | MAP_LOCKED)");
    let fault = locked.expect_err("locked");
    assert_eq!(
        (fault.cause, fault.message.contains("(mmap of locked memory) during step 3")),
        (Cause::Forbidden, true),
        "{fault}"
    );
    let huge = "if (map(2 * ONE_MB, PROT_READ, PRIVATE | MAP_HUGETLB)) abort()";
    assert!(memory_of("IN_STEP", huge).is_ok());
}

#[test]
fn the_first_stack_is_limited() {
    let fault = memory_of("IN_STEP", "deep(1024)").expect_err("too deep");
    assert!(fault.message.contains("SIGSEGV") || fault.message.contains("SIGABRT"), "{fault}");
}

#[test]
fn threads_that_allocate_and_guard_pages_without_end_are_honest() {
    let work = "for (int round = 0; round < 20; round++) many(honest, 1 << 20); \
                for (int n = 0; n < 20000; n++) { mprotect(page(), 4096, PROT_NONE); \
                if (mprotect(page(), 4096, PROT_READ | PROT_WRITE)) abort(); }";
    let helpers = "static char *page(void) { static char *p; if (!p) p = mmap(NULL, 4096, PROT_READ | PROT_WRITE, \
                   MAP_PRIVATE | MAP_ANONYMOUS, -1, 0); return p; }\n\
                   static void *honest(void *nothing) { for (int n = 1; n < 64; n++) { char *p = malloc(n * 4096); \
                   if (!p) abort(); memset(p, 1, n * 4096); free(p); } char *p = malloc(200000); \
                   for (int n = 2; n < 5; n++) { p = realloc(p, n * 100000); if (!p) abort(); } free(p); return nothing; }\n";
    let source = HOSTILE.replacen("static void attack", HELPERS, 1);
    let source = source.replacen("static void attack", &format!("{helpers}static void attack"), 1);
    let (_folder, dirs) =
        folder_with("hostile", &format!("#define IN_STEP\n#define ATTACK {work}\n{source}"));
    let mut desk = Desk::new(&dirs, HostConfig { memory_limit_bytes: LIMIT, ..config() });
    desk.ask(ONE, opening("hostile", &Parameters::new(), None)).expect("it opens");
    for tick in 0..6 {
        let given = desk.ask(ONE, step(tick));
        assert!(matches!(given, Ok(Given::Command(_))), "{given:?}");
    }
}
