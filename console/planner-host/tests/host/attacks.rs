//! Planners that attack: none reaches anything outside its process, and each attempt is a fault that names it.
#![cfg(target_os = "linux")]

use crate::desk::{Desk, LONG, ONE, opening, step as desk_step};
use crate::stand::{built, choose, config, folder_with, plan, step, worker};
use mission::planner::Parameters;
use mission::{Cause, Fault, Given, Sandbox};
use planner_host::{BlockingHost, PluginDirs, survey};
use std::path::Path;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const HOSTILE: &str = include_str!("../../../../plugins/faulty/hostile.c");

/// A plugin that carries out this attack at this moment.
fn hostile(moment: &str, attack: &str) -> (TempDir, PluginDirs) {
    folder_with("hostile", &format!("#define {moment}\n#define ATTACK {attack}\n{HOSTILE}"))
}

/// A host for that plugin and for the planners that were built with this test.
fn host(dirs: &PluginDirs) -> BlockingHost {
    let dirs = dirs.folders.iter().chain(&built().folders).cloned().collect();
    BlockingHost::new(&PluginDirs::of(dirs), config())
}

/// The fault of a planner that attacks at this moment; the fault must occur within 50 steps.
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

/// Asserts that this system can fully sandbox a planner's process, so that no hostile code runs outside a sandbox.
fn assert_sealed() {
    let (_folder, dirs) = hostile("IN_STEP", "");
    let survey = survey(&dirs, &worker());
    assert_eq!(
        survey.plugins[0].planners[0].sandbox,
        Some(Sandbox::Full),
        "attacks are only tried in a full sandbox"
    );
}

/// The reason that the survey gives for refusing a plugin that attacks in its constructor.
fn refusal_of(attack: &str) -> String {
    assert_sealed();
    let (_folder, dirs) = hostile("IN_CONSTRUCTOR", attack);
    survey(&dirs, &worker()).plugins[0].refused.clone().expect("refused")
}

/// An attack, and the system call that the fault names.
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
    // Signal 0, so that the machine that runs this test survives if the sandbox fails.
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
    ("mmap(NULL, 4096, PROT_READ, MAP_SHARED | MAP_ANONYMOUS, -1, 0)", "mmap of shared memory"),
    ("mmap(NULL, 4096, PROT_READ, MAP_SHARED, 201, 0)", "mmap of shared memory"),
    // Zero bytes, so that the machine that runs this test survives if the sandbox fails.
    ("madvise(NULL, 0, 100)", "madvise"),
    ("madvise(NULL, 0, 101)", "madvise"),
    ("nice(5)", "setpriority"),
    ("syscall(SYS_clone, CLONE_PARENT | SIGCHLD, 0, 0, 0, 0)", "clone"),
    // A storm of alarms would slow every step.
    (
        "struct itimerval often = {{0, 1}, {0, 1}}; signal(SIGALRM, SIG_IGN); setitimer(ITIMER_REAL, &often, NULL)",
        "setitimer",
    ),
    ("syscall(SYS_getpriority, 0, getppid())", "getpriority"),
    // Paths that begin in a folder of libraries but lead elsewhere.
    (r#"open("/usr/lib/../../etc/shadow", O_RDONLY | O_CLOEXEC)"#, "openat of /usr/lib/../../etc/shadow"),
    (r#"open("/proc/self/../1/environ", O_RDONLY)"#, "openat of /proc/self/../1/environ"),
    (r#"open("/proc/self/fd/../../../etc/shadow", O_RDONLY)"#, "openat of /proc/self/fd/../../../etc/shadow"),
    (r#"open("/proc/self/mem", O_RDWR)"#, "openat of /proc/self/mem"),
    (r#"struct stat about; stat("/etc/shadow", &about)"#, "newfstatat of /etc/shadow"),
    // Attacks on the channel and on other descriptors.
    ("shutdown(200, SHUT_RDWR)", "shutdown"),
    ("dup2(1, 200)", "dup2"),
    ("fcntl(200, F_DUPFD, 3)", "fcntl"),
    ("fcntl(200, F_SETFL, 0)", "fcntl"),
    ("ioctl(200, FIONREAD, NULL)", "ioctl"),
    ("setsockopt(200, SOL_SOCKET, SO_RCVBUF, NULL, 0)", "setsockopt"),
    ("syscall(SYS_splice, 200, NULL, 1, NULL, 1, 0)", "splice"),
    // Other ways to watch or change other processes, or to outlive the worker.
    ("syscall(SYS_userfaultfd, 0)", "userfaultfd"),
    ("syscall(SYS_perf_event_open, NULL, 0, -1, -1, 0)", "perf_event_open"),
    ("syscall(SYS_keyctl, 0, -3, 0)", "keyctl"),
    (r#"syscall(SYS_mount, "none", "/mnt", "tmpfs", 0, NULL)"#, "mount"),
    ("syscall(SYS_setns, 0, 0)", "setns"),
    (r#"chroot("/")"#, "chroot"),
    ("syscall(SYS_personality, 0x0040000)", "personality"),
    ("syscall(SYS_seccomp, 1, 0, NULL)", "seccomp"),
    ("syscall(SYS_prctl, 4, 0, 0, 0, 0)", "prctl"),
    ("mlockall(MCL_CURRENT)", "mlockall"),
    ("syscall(SYS_timer_create, 0, NULL, NULL)", "timer_create"),
    ("syscall(SYS_sched_setscheduler, 0, 1, NULL)", "sched_setscheduler"),
    ("syscall(SYS_sched_setaffinity, getppid(), 8, NULL)", "sched_setaffinity"),
    ("syscall(SYS_rt_sigqueueinfo, getppid(), SIGCONT, NULL)", "rt_sigqueueinfo"),
    ("syscall(438, 0, 0, 0)", "pidfd_getfd"),
    ("syscall(SYS_shmget, 0, 4096, 0)", "shmget"),
    (r#"syscall(SYS_mq_open, "/q", O_CREAT, 0600, NULL)"#, "mq_open"),
    ("syscall(SYS_inotify_init1, 0)", "inotify_init1"),
    ("syscall(SYS_vfork)", "vfork"),
    ("kill(0, 0)", "kill"),
    ("syscall(SYS_tkill, getppid(), SIGSTOP)", "tkill"),
    // Tricks against a filter that reports inside the process do not help, because the kernel reports the call to the
    // console.
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
            "planner hostile tried a forbidden system call ({call}) during step 3; its process was killed"
        );
        assert_eq!((fault.message, fault.cause), (sentence, Cause::Forbidden), "{attack}");
        assert!(fault.plugin_sha256.is_some());
    }
}

#[test]
fn attacks_in_a_constructor_do_not_even_harm_who_only_lists_planners() {
    for (attack, call) in ATTACKS {
        let sentence =
            format!("tried a forbidden system call ({call}) while being loaded; its process was killed");
        assert_eq!(refusal_of(attack), sentence, "{attack}");
    }
}

#[test]
fn attacks_in_a_thread_that_stays_are_named_at_the_step_in_progress() {
    let fault = fault_of("IN_THREAD", r#"open("/etc/passwd", O_RDONLY)"#);
    assert_eq!(fault.cause, Cause::Forbidden, "{fault}");
    let begin = "planner hostile tried a forbidden system call (openat of /etc/passwd) during step ";
    assert!(fault.message.starts_with(begin), "{fault}");
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
fn an_instance_that_does_not_end_well_is_no_fault_of_the_next_mission() {
    // The last attack leaves a thread behind, which ends the process between two missions.
    for (moment, attack) in [
        ("IN_DESTROY", "abort()"),
        ("IN_DESTROY", "socket(AF_UNIX, SOCK_STREAM, 0)"),
        ("IN_LEFTOVER", "rest(60), raise(SIGALRM)"),
    ] {
        let (_folder, dirs) = hostile(moment, attack);
        let mut desk = Desk::new(&dirs, config());
        for _ in 0..3 {
            let opened = desk.ask(ONE, opening("hostile", &Parameters::new(), None));
            assert!(matches!(opened, Ok(Given::Opened(_))), "{attack}: {opened:?}");
            (0..4).for_each(|tick| drop(desk.ask(ONE, desk_step(tick)).unwrap()));
            desk.host.end_mission();
            std::thread::sleep(Duration::from_millis(200));
        }
        let opened = desk.ask(ONE, opening("hostile", &Parameters::new(), None));
        assert!(opened.is_ok(), "{attack}: {opened:?}");
        let ends = desk.host.take_bad_ends();
        assert!(ends.iter().any(|end| end.planner == "hostile"), "{attack}: {ends:?}");
    }
}

#[test]
fn a_call_of_another_kind_of_processor_ends_the_process_without_a_name() {
    if cfg!(target_arch = "x86_64") {
        let fault = fault_of("IN_STEP", r#"__asm__ volatile("int $0x80" : : "a"(20) : "memory")"#);
        let sentence =
            "planner hostile was killed by SIGSYS (a system call that no planner may make) during step 3";
        assert_eq!((fault.message.as_str(), fault.cause), (sentence, Cause::Died));
    }
}

#[test]
fn a_call_by_the_numbers_of_another_interface_is_never_made() {
    if cfg!(target_arch = "x86_64") {
        let fault = fault_of("IN_STEP", "syscall(0x40000000 | SYS_getpid)");
        assert_eq!(fault.cause, Cause::Forbidden, "{fault}");
    }
}

#[test]
fn descriptors_that_a_planner_sends_reach_nobody() {
    let send = "char space[CMSG_SPACE(4)] = {0}, bytes[4] = {-1, -1, -1, -1}; struct iovec one = {bytes, 4}; \
                struct msghdr message = {.msg_iov = &one, .msg_iovlen = 1, .msg_control = space, .msg_controllen = sizeof space}; \
                struct cmsghdr *part = CMSG_FIRSTHDR(&message); part->cmsg_level = SOL_SOCKET; part->cmsg_type = SCM_RIGHTS; \
                part->cmsg_len = CMSG_LEN(4); *(int *)(void *)CMSG_DATA(part) = 1; sendmsg(200, &message, 0)";
    let open = || std::fs::read_dir("/proc/self/fd").unwrap().count();
    let before = open();
    let fault = fault_of("IN_STEP", send);
    assert_eq!(fault.cause, Cause::Protocol, "{fault}");
    // Other tests in this process open files, too, but not a thousand of them.
    assert!(open() < before + 200);
}

#[test]
fn the_end_of_the_main_thread_is_silence_and_its_process_is_killed() {
    let fault = fault_of("IN_STEP", "syscall(SYS_exit, 0)");
    assert_eq!(fault.cause, Cause::Hung, "{fault}");
    let fault = fault_of("IN_STEP", "pthread_exit(NULL)");
    assert_eq!(fault.cause, Cause::Died, "the console's own code is on that stack, too: {fault}");
}

#[test]
fn ways_to_end_are_distinguished() {
    let ends = [
        ("exit(3)", "planner hostile ended its own process with exit code 3 during step 3"),
        ("quick_exit(4)", "planner hostile ended its own process with exit code 4 during step 3"),
        ("raise(SIGALRM)", "planner hostile was killed by SIGALRM (an alarm that it had set) during step 3"),
        (
            "raise(SIGUSR2)",
            "planner hostile was killed by SIGUSR2 (sent by itself or from outside) during step 3",
        ),
        (
            "alarm(1); rest(1900)",
            "planner hostile was killed by SIGALRM (an alarm that it had set) during step 3",
        ),
        ("raise(SIGTRAP)", "planner hostile was killed by SIGTRAP (a breakpoint) during step 3"),
    ];
    for (how, sentence) in ends {
        let fault = fault_of("IN_STEP", how);
        assert_eq!((fault.message.as_str(), fault.cause), (sentence, Cause::Died), "{how}");
    }
}

#[test]
fn a_library_cannot_say_that_it_is_another_file_or_lies_about_what_it_has() {
    let honest = {
        let (_folder, dirs) = hostile("IN_STEP", "");
        survey(&dirs, &worker()).plugins[0].planners[0].sha256.clone()
    };
    let text = |text: &str| [&[text.len() as u8], text.as_bytes()].concat();
    // Full, another hash, ABI 1.0.
    let sealed = [vec![0], text("ab"), vec![1, 0]].concat();
    assert_eq!(refusal_of(&sending(0x84, 1, &sealed)), "sent an invalid reply while being loaded");
    // One planner: id, name, version, about; no abilities, state 1, no parameters.
    let named = |id: &str| [vec![1], text(id), vec![0; 4], vec![1], vec![0]].concat();
    let surveyed = |done: &str| {
        let (_folder, dirs) = hostile("IN_CONSTRUCTOR", &format!("{done}; rest(200)"));
        survey(&dirs, &worker()).plugins.remove(0)
    };
    let lying = surveyed(&sending(0x80, 1, &named("spiral")));
    assert_eq!((lying.planners[0].id.as_str(), &lying.planners[0].sha256), ("spiral", &lying.sha256));
    assert_ne!(lying.sha256, honest, "the hash of this very file");
    let unsound = surveyed(&sending(0x80, 1, &named("two words")));
    assert_eq!(unsound.refused.as_deref(), Some("sent an invalid reply while being loaded"));
}

/// Writes a frame to the console, in C.
fn sending(kind: u8, sequence: u32, body: &[u8]) -> String {
    let rest = [&[kind], &sequence.to_le_bytes()[..], &[0; 4], body].concat();
    let frame = [&(rest.len() as u32).to_le_bytes()[..], &rest].concat();
    let octal: Vec<String> = frame.iter().map(|byte| format!("\\{byte:03o}")).collect();
    format!("write(200, \"{}\", {})", octal.concat(), frame.len())
}

#[test]
fn frames_that_nobody_asked_for_are_no_answers() {
    for kind in [0x80, 0x84] {
        let fault = fault_of("IN_STEP", &sending(kind, u32::MAX, &[]));
        let sentence = "planner hostile sent an invalid reply during step 3; its process was killed";
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
fn a_planner_has_the_memory_that_is_documented_and_no_more() {
    let hoard = "int mb = 0; while (malloc(1 << 20)) mb++; _exit(mb >= 245 && mb <= 256 ? 9 : mb % 256)";
    let fault = fault_of("IN_STEP", hoard);
    assert_eq!(fault.message, "planner hostile ended its own process with exit code 9 during step 3");
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
    assert!(
        fault.message.contains("exit code 62"),
        "the worker's own two threads count towards the 64: {fault}"
    );
}

#[test]
fn honest_work_is_not_disturbed() {
    let work = "pthread_t thread; void *memory = malloc(32 << 20); char bytes[16]; struct stat about; \
                if (!memory || pthread_create(&thread, NULL, sum, memory) || pthread_join(thread, NULL)) abort(); \
                free(memory); if (getentropy(bytes, 16)) abort(); rest(1); time(NULL); fstat(1, &about); \
                printf(\"%ld processors, %d\\n\", sysconf(_SC_NPROCESSORS_ONLN), isatty(1)); fflush(stdout); \
                localtime(&(time_t){0}); qsort(calloc(9999, 8), 9999, 8, order); \
                struct stat printed; if (fstat(1, &printed) || !S_ISFIFO(printed.st_mode)) abort(); \
                if (!pthread_create(&thread, NULL, sum, NULL)) { pthread_setname_np(thread, \"theirs\"); pthread_join(thread, NULL); } char place[64]; getcwd(place, 64)";
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
