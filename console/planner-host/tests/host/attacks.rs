//! Planners that attack: none reaches anything outside its process, and each attempt is a fault that names it.
#![cfg(target_os = "linux")]

use crate::desk::LONG;
use crate::stand::{built, choose, config, folder_with, plan, step, worker};
use mission::planner::Parameters;
use mission::{Cause, Fault, Sandbox};
use planner_host::{BlockingHost, PluginDirs, survey};
use std::path::Path;
use std::time::Instant;
use tempfile::TempDir;

const HOSTILE: &str = include_str!("../../../../plugins/faulty/hostile.c");

/// A plugin that does this at this moment.
fn hostile(moment: &str, attack: &str) -> (TempDir, PluginDirs) {
    folder_with("hostile", &format!("#define {moment}\n#define ATTACK {attack}\n{HOSTILE}"))
}

/// A host for it, and for the planners that were built with this test.
fn host(dirs: &PluginDirs) -> BlockingHost {
    let dirs = dirs.folders.iter().chain(&built().folders).cloned().collect();
    BlockingHost::new(&PluginDirs::of(dirs), config())
}

/// The fault of a planner that does this in its fourth step, or until 50 steps have been made.
fn fault_of(moment: &str, attack: &str) -> Fault {
    let (_folder, dirs) = hostile(moment, attack);
    let mut host = host(&dirs);
    let info = choose(&mut host, "hostile", &Parameters::new()).expect("it loads");
    assert_eq!(info.sandbox, Some(Sandbox::Full));
    plan(&mut host).expect("it plans");
    let fault = (0..50).find_map(|tick| step(&mut host, tick).err()).expect("a fault");
    assert_another_drives(&mut host);
    fault
}

fn assert_another_drives(host: &mut BlockingHost) {
    choose(host, "faulty", &Parameters::new()).unwrap();
    assert!(plan(host).unwrap().value.complete);
    step(host, 0).unwrap();
}

/// Makes sure that nothing hostile runs where this system cannot close off a planner's process.
fn assert_sealed() {
    let (_folder, dirs) = hostile("IN_STEP", "");
    let survey = survey(&dirs, &worker());
    assert_eq!(
        survey.plugins[0].planners[0].sandbox,
        Some(Sandbox::Full),
        "attacks are only tried in a full sandbox"
    );
}

/// What is said of a plugin that does this in its constructor, while plugins are only listed.
fn refusal_of(attack: &str) -> String {
    assert_sealed();
    let (_folder, dirs) = hostile("IN_CONSTRUCTOR", attack);
    survey(&dirs, &worker()).plugins[0].refused.clone().expect("refused")
}

/// An attack, and the call of the system that is named.
const ATTACKS: &[(&str, &str)] = &[
    (r#"open("/etc/passwd", O_RDONLY)"#, "openat of /etc/passwd"),
    (r#"open("/etc/passwd", O_RDONLY | O_CLOEXEC)"#, "openat of /etc/passwd"),
    (r#"open("/nonexistent/key", O_RDWR | O_CREAT, 0600)"#, "openat of /nonexistent/key"),
    (r#"fopen("/etc/passwd", "a")"#, "openat of /etc/passwd"),
    (r#"open("/dev/tty", O_RDWR)"#, "openat of /dev/tty"),
    (r#"open(of_parent("mem"), O_RDWR)"#, "openat of /proc/PID/mem"),
    (r#"open(of_parent("fd/1"), O_WRONLY)"#, "openat of /proc/PID/fd/1"),
    (r#"unlink("/nonexistent/events.jsonl")"#, "unlink"),
    (r#"truncate("/nonexistent/events.jsonl", 0)"#, "truncate"),
    (r#"rename("/nonexistent/a", "/nonexistent/b")"#, "rename"),
    (r#"chmod("/nonexistent/a", 0777)"#, "chmod"),
    (r#"chdir("/")"#, "chdir"),
    ("socket(AF_INET, SOCK_STREAM, 0)", "socket"),
    ("socket(AF_UNIX, SOCK_STREAM, 0)", "socket"),
    ("listen(200, 1)", "listen"),
    ("ioctl(1, TIOCSTI, \"q\")", "ioctl"),
    ("tcsetpgrp(1, getpid())", "ioctl"),
    ("ptrace(PTRACE_SEIZE, getppid(), 0, 0)", "ptrace"),
    ("process_vm_writev(getppid(), NULL, 0, NULL, 0, 0)", "process_vm_writev"),
    ("process_vm_readv(getppid(), NULL, 0, NULL, 0, 0)", "process_vm_readv"),
    ("kill(getppid(), SIGKILL)", "kill"),
    ("kill(getppid(), SIGSTOP)", "kill"),
    // Signal 0: where a seal is broken, the machine that runs this test survives it.
    ("kill(-1, 0)", "kill"),
    ("syscall(SYS_tgkill, getppid(), getppid(), SIGSTOP)", "tgkill"),
    ("struct rlimit one = {1, 1}; prlimit(getppid(), RLIMIT_NOFILE, &one, NULL)", "prlimit64"),
    ("struct rlimit all = {RLIM_INFINITY, RLIM_INFINITY}; setrlimit(RLIMIT_AS, &all)", "prlimit64"),
    ("setpriority(PRIO_PROCESS, getppid(), 19)", "setpriority"),
    ("if (fork() == 0) for (;;) rest(1000)", "fork"),
    ("if (fork() == 0) { setsid(); if (fork() == 0) for (;;) rest(1000); _exit(0); }", "fork"),
    ("system(\"sleep 1000 &\")", "fork"),
    (r#"char *none[] = {NULL}; execve("/bin/sh", none, none)"#, "execve"),
    ("setsid()", "setsid"),
    ("memfd_create(\"hoard\", 0)", "memfd_create"),
    ("syscall(425, 1, NULL)", "io_uring_setup"),
    ("syscall(434, getppid(), 0)", "pidfd_open"),
    ("syscall(SYS_bpf, 0, NULL, 0)", "bpf"),
    ("unshare(CLONE_NEWUSER)", "unshare"),
    // What a filter of its own process could be caught with does not help: the kernel reports elsewhere.
    (
        "sigset_t all; sigfillset(&all); sigprocmask(SIG_BLOCK, &all, NULL); signal(SIGSYS, SIG_IGN); \
         for (int fd = 0; fd < 199; fd++) close(fd); socket(AF_UNIX, SOCK_STREAM, 0)",
        "socket",
    ),
];

#[test]
fn attacks_in_a_step_are_never_made_and_named_with_planner_call_and_step() {
    for (attack, call) in ATTACKS {
        let fault = fault_of("IN_STEP", attack);
        let sentence = format!(
            "planner hostile tried {call} during step 3, which no planner may do; its process was killed"
        );
        assert_eq!((fault.message, fault.cause), (sentence, Cause::Forbidden), "{attack}");
        assert!(fault.plugin_sha256.is_some());
    }
}

#[test]
fn attacks_in_a_constructor_do_not_even_harm_who_only_lists_planners() {
    for (attack, call) in ATTACKS {
        let sentence =
            format!("tried {call} while it was loaded, which no planner may do; its process was killed");
        assert_eq!(refusal_of(attack), sentence, "{attack}");
    }
}

#[test]
fn attacks_in_a_thread_that_stays_are_named_at_the_step_in_progress() {
    let fault = fault_of("IN_THREAD", r#"open("/etc/passwd", O_RDONLY)"#);
    assert_eq!(fault.cause, Cause::Forbidden, "{fault}");
    assert!(fault.message.starts_with("planner hostile tried openat of /etc/passwd during step "), "{fault}");
}

#[test]
fn a_destructor_that_attacks_reaches_nothing_and_ends_with_its_process() {
    let folder = tempfile::tempdir().unwrap();
    let canary = folder.path().join("canary");
    let attack = format!("creat(\"{}\", 0600); for (;;) rest(1000)", canary.display());
    let (_folder, dirs) = hostile("IN_DESTRUCTOR", &attack);
    let mut host = host(&dirs);
    choose(&mut host, "hostile", &Parameters::new()).unwrap();
    let began = Instant::now();
    assert_another_drives(&mut host);
    drop(host);
    assert!(!canary.exists());
    assert!(began.elapsed() < LONG);
}

#[test]
fn a_call_of_another_kind_of_processor_ends_the_process_without_a_name() {
    if cfg!(target_arch = "x86_64") {
        let fault = fault_of("IN_STEP", r#"__asm__ volatile("int $0x80" : : "a"(20) : "memory")"#);
        let sentence = "planner hostile was killed by SIGSYS (a call of the system that no planner may make) during step 3";
        assert_eq!((fault.message.as_str(), fault.cause), (sentence, Cause::Died));
    }
}

#[test]
fn frames_that_nobody_asked_for_are_no_answers() {
    // The length, DONE or SEALED, another sequence number, no deadline.
    for kind in ["x80", "x84"] {
        let forged = format!(r#"write(200, "\x09\0\0\0\{kind}\xff\xff\xff\xff\0\0\0\0", 13)"#);
        let fault = fault_of("IN_STEP", &forged);
        let sentence =
            "planner hostile sent something that is no answer during step 3; its process was killed";
        assert_eq!((fault.message.as_str(), fault.cause), (sentence, Cause::Protocol));
    }
}

#[test]
fn a_planner_that_closes_all_descriptors_or_ends_with_any_code_loses_only_itself() {
    let closed = fault_of("IN_STEP", "for (int fd = 0; fd < 4096; fd++) close(fd)");
    assert_eq!(closed.message, "planner hostile lost its channel to the console during step 3");
    let exited = fault_of("IN_STEP", "_exit(70)");
    assert_eq!(exited.message, "planner hostile ended its own process with exit code 70 during step 3");
}

#[test]
fn what_the_console_was_started_with_is_not_open_in_a_worker() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("of the shell");
    let inherited = rustix::io::dup(std::fs::File::create(&path).unwrap()).unwrap();
    let attack = "for (int fd = 3; fd < 199; fd++) write(fd, \"x\", 1)";
    let (_folder, dirs) = hostile("IN_STEP", attack);
    let mut host = host(&dirs);
    choose(&mut host, "hostile", &Parameters::new()).unwrap();
    (0..5).for_each(|tick| drop(step(&mut host, tick).unwrap()));
    drop(inherited);
    assert_eq!(std::fs::read(path).unwrap(), b"");
}

#[test]
fn low_descriptors_can_be_closed_without_harm() {
    let (_folder, dirs) = hostile("IN_STEP", "for (int fd = 3; fd < 200; fd++) close(fd)");
    let mut host = host(&dirs);
    choose(&mut host, "hostile", &Parameters::new()).unwrap();
    (0..10).for_each(|tick| drop(step(&mut host, tick).unwrap()));
}

#[test]
fn threads_are_limited() {
    let attack = "pthread_t thread; pthread_attr_t small; pthread_attr_init(&small); \
                  pthread_attr_setstacksize(&small, 16384); int n = 0; \
                  while (pthread_create(&thread, &small, later_still, NULL) == 0) n++; _exit(n)";
    let source = HOSTILE.replace(
        "static void attack",
        "static void *later_still(void *nothing) { for (;;) rest(1000); return nothing; }\nstatic void attack",
    );
    let (_folder, dirs) =
        folder_with("hostile", &format!("#define IN_STEP\n#define ATTACK {attack}\n{source}"));
    let mut host = host(&dirs);
    choose(&mut host, "hostile", &Parameters::new()).unwrap();
    let fault = (0..4).find_map(|tick| step(&mut host, tick).err()).expect("a fault");
    assert!(fault.message.contains("exit code 62"), "its own two are two of 64: {fault}");
}

#[test]
fn honest_work_is_not_disturbed() {
    let work = "pthread_t thread; void *memory = malloc(32 << 20); char bytes[16]; struct stat about; \
                if (!memory || pthread_create(&thread, NULL, sum, memory) || pthread_join(thread, NULL)) abort(); \
                free(memory); if (getentropy(bytes, 16)) abort(); rest(1); time(NULL); fstat(1, &about); \
                printf(\"%ld processors, %d\\n\", sysconf(_SC_NPROCESSORS_ONLN), isatty(1)); fflush(stdout); \
                localtime(&(time_t){0}); qsort(calloc(9999, 8), 9999, 8, order)";
    let helpers = "static void *sum(void *memory) { return memory; }\n\
                   static int order(const void *a, const void *b) { return a < b; }\nstatic void attack";
    let source = HOSTILE.replacen("static void attack", helpers, 1);
    for moment in ["IN_CONSTRUCTOR", "IN_STEP"] {
        let (_folder, dirs) =
            folder_with("hostile", &format!("#define {moment}\n#define ATTACK {work}\n{source}"));
        let mut host = host(&dirs);
        choose(&mut host, "hostile", &Parameters::new()).unwrap();
        (0..10).for_each(|tick| drop(step(&mut host, tick).unwrap()));
    }
}

#[test]
fn exceptions_of_cpp_work() {
    let folder = tempfile::tempdir().unwrap();
    let source = "#include <stdexcept>\n#include <thread>\n#include <vector>\n#include <algorithm>\n#include <random>\n\
                  extern \"C\" int work() {\n  int caught = 0;\n  std::thread other([&] { try { throw std::runtime_error(\"x\"); } \
                  catch (const std::exception &) { caught++; } });\n  other.join();\n  try { std::vector<int>().at(7); } \
                  catch (const std::out_of_range &) { caught++; }\n  return caught + (std::random_device{}() == 0 ? 0 : 1) + \
                  (std::thread::hardware_concurrency() > 0);\n}\n";
    let object = compile_cpp(folder.path(), source);
    let hostile = HOSTILE.replacen("static void attack", "int work(void);\nstatic void attack", 1);
    let source = folder.path().join("hostile.c");
    let attack = "if (work() != 4) abort()";
    std::fs::write(&source, format!("#define IN_STEP\n#define ATTACK {attack}\n{hostile}")).unwrap();
    crate::stand::compile_with(
        &source,
        folder.path(),
        "hostile",
        &[],
        &[object.as_os_str(), "-lstdc++".as_ref()],
    );
    let mut host = host(&PluginDirs::of(vec![folder.path().to_owned()]));
    choose(&mut host, "hostile", &Parameters::new()).unwrap();
    (0..10).for_each(|tick| drop(step(&mut host, tick).unwrap()));
}

fn compile_cpp(folder: &Path, source: &str) -> std::path::PathBuf {
    let (text, object) = (folder.join("work.cpp"), folder.join("work.o"));
    std::fs::write(&text, source).unwrap();
    let mut compiler = std::process::Command::new("c++");
    let compiled = compiler.args(["-O1", "-fPIC", "-c", "-o"]).args([&object, &text]).output().unwrap();
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    object
}
