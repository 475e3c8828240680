//! Planners that attack during a flight: the reports about them, the proof afterwards, and the controls that the
//! operator keeps.

use crate::{
    bench::{Bench, Ended, journal, of_kind, scenario, workspace},
    session::Session,
};
use std::path::{Path, PathBuf};

/// A folder with the planner `hostile`, which makes this attack at this moment.
pub(crate) fn hostile(bench: &Bench, moment: &str, attack: &str) -> PathBuf {
    let source = std::fs::read_to_string(workspace().join("plugins/faulty/hostile.c")).unwrap();
    let source = bench.file("hostile.c", format!("#define {moment}\n#define ATTACK {attack}\n{source}"));
    let folder = bench.path().join("hostile");
    std::fs::create_dir_all(&folder).unwrap();
    crate::faults::compile_file(&source, &folder.join("libplanner_hostile.so"));
    folder
}

fn fly(bench: &Bench, plugins: &Path) -> Ended {
    let more = ["--planner", "hostile", "--set", "planner.fallback.id=apf", "--plugin-dir"];
    let more = [&more[..], &[plugins.to_str().unwrap()]].concat();
    bench.fly(&scenario("goto-single-obstacle.toml"), &more)
}

/// The time of the attack depends on the machine, so the same requests do not give the same fault again.
#[test]
fn a_fault_of_a_thread_that_outlives_its_step_is_taken_from_the_journal() {
    let attacks = [
        r#"write(200, "01234567890123456789012345678901", 32)"#,
        "abort()",
        r#"open("/etc/passwd", O_RDONLY)"#,
        "_exit(3)",
        "for (;;) memset(malloc(1 << 20), 1, 1 << 20)",
    ];
    for attack in attacks {
        let bench = Bench::new();
        let plugins = hostile(&bench, "IN_LEFTOVER", attack);
        for _ in 0..3 {
            let flown = fly(&bench, &plugins);
            assert_eq!(flown.json()["outcome"], "complete", "{attack}: {flown:?}");
            assert_eq!(flown.json()["planner_faults"], 1, "{attack}: {flown:?}");
            let run = bench.runs().pop().unwrap();
            let verified = bench.verify(&run, &["--plugin-dir", plugins.to_str().unwrap()]);
            assert_eq!(verified.code, Some(0), "{attack}: {verified:?}");
            let note = "note: external or timing faults of planner hostile, taken from the journal: 1";
            assert!(verified.out.contains(note), "{attack}: {verified:?}");
        }
    }
}

#[test]
fn a_plugin_that_is_refused_is_named_with_the_reason_to_who_wants_its_planner() {
    let bench = Bench::new();
    let plugins = hostile(&bench, "IN_CONSTRUCTOR", "socket(AF_INET, SOCK_STREAM, 0)");
    let refused = fly(&bench, &plugins);
    let sentence = "planner `hostile` cannot be chosen: plugin libplanner_hostile.so is refused: tried a forbidden system call (socket) while being loaded";
    assert!(refused.code == Some(2) && refused.err.contains(sentence), "{refused:?}");
    std::fs::rename(plugins.join("libplanner_hostile.so"), plugins.join("libplanner_x.so")).unwrap();
    let refused = fly(&bench, &plugins);
    let sentence = "there is no planner `hostile`; found: ";
    let reason =
        "; plugin libplanner_x.so is refused: tried a forbidden system call (socket) while being loaded";
    assert!(refused.err.contains(sentence) && refused.err.contains(reason), "{refused:?}");
}

#[test]
fn a_planner_that_does_not_end_well_when_it_is_destroyed_is_named() {
    let attacks = [
        ("abort()", "was killed by SIGABRT"),
        ("for (;;) rest(1000)", "took more than 0.1 s to shut down"),
        (r#"open("/etc/passwd", O_RDONLY)"#, "tried a forbidden system call (openat of /etc/passwd)"),
        ("_exit(3)", "ended its own process with exit code 3"),
    ];
    for (attack, how) in attacks {
        let bench = Bench::new();
        let plugins = hostile(&bench, "IN_DESTROY", attack);
        let more = ["--planner", "hostile", "--set", "mission.time_limit_s=1", "--plugin-dir"];
        let more = [&more[..], &[plugins.to_str().unwrap()]].concat();
        let flown = bench.fly(&scenario("goto-single-obstacle.toml"), &more);
        let log = std::fs::read_to_string(bench.runs()[0].join("planner.log")).unwrap_or_default();
        for text in [&flown.err, &log] {
            let (before, after) =
                text.split_once(how).unwrap_or_else(|| panic!("{attack}: {flown:?}, {log}"));
            assert!(
                before.ends_with("planner hostile ") && after.contains("while being destroyed"),
                "{text}"
            );
        }
        assert_eq!(flown.json()["planner_faults"], 0, "the mission was over: {flown:?}");
    }
}

/// The result of `tankops check` on a changed copy of the C example.
fn checked(change: (&str, &str), head: &str) -> Ended {
    let bench = Bench::new();
    let source = std::fs::read_to_string(workspace().join("plugins/examples/direct-c/direct.c")).unwrap();
    assert!(source.contains(change.0));
    let source = bench.file("changed.c", format!("{head}\n{}", source.replacen(change.0, change.1, 1)));
    let plugin = bench.path().join("libplanner_changed.so");
    crate::faults::compile_file(&source, &plugin);
    bench.tankops(&["check", plugin.to_str().unwrap(), "--fly", "1"])
}

#[test]
fn a_check_finds_what_crashes_when_it_is_destroyed_and_threads_that_stay() {
    let crashes = checked(("free(instance);", "free(instance); abort();"), "");
    let line = "FAIL  ends when told to: tank with seed 0: planner direct-c was killed by SIGABRT";
    assert!(crashes.code == Some(1) && crashes.out.contains(line), "{crashes:?}");
    let stays = "#define _GNU_SOURCE\n#include <pthread.h>\n#include <time.h>\nstatic void *stay(void *p) { for (;;) { struct timespec s = {9, 0}; nanosleep(&s, 0); } \
                 return p; }";
    let start = "static int n; pthread_t t; if (n++ == 2) pthread_create(&t, 0, stay, 0);\n  const direct *self = instance;";
    let threads = checked(("const direct *self = instance;", start), stays);
    let line = "warn  leaves no thread behind: 1 thread is still running between its calls";
    assert!(threads.code == Some(0) && threads.out.contains(line), "{threads:?}");
}

#[test]
fn a_line_without_an_end_is_kept_by_its_beginning() {
    let bench = Bench::new();
    let flood = "static char much[100000]; memset(much, 'x', sizeof much); for (int i = 0; i < 1000; i++) write(2, much, sizeof much)";
    fly(&bench, &hostile(&bench, "IN_STEP", flood));
    let plugins = bench.path().join("hostile");
    let more = ["--planner", "hostile", "--set", "mission.time_limit_s=3", "--plugin-dir"];
    bench.fly(&scenario("goto-single-obstacle.toml"), &[&more[..], &[plugins.to_str().unwrap()]].concat());
    let log = std::fs::read_to_string(bench.runs().pop().unwrap().join("planner.log")).unwrap();
    assert!(log.contains("hostile: xxx") && log.contains("x (rest of the line dropped)\n"), "{log}");
    assert!(log.len() < 2000, "{}", log.len());
}

#[test]
fn a_replay_says_which_step_did_not_answer_and_after_how_long() {
    let bench = Bench::new();
    fly(&bench, &hostile(&bench, "IN_STEP", "for (;;) rest(1000)"));
    let bundle = bench.runs()[0].join("crash-1");
    let replayed = bench.tankops(&["replay-worker", bundle.to_str().unwrap()]);
    let sentence = "(step 3): planner hostile did not finish step 3 in time and ignored the request to stop; its process was killed (its budget is 2.0 s)";
    assert!(replayed.code == Some(1) && replayed.out.contains(sentence), "{replayed:?}");
}

/// A crash bundle of a planner that gives this answer in its fourth step.
fn bundle(bench: &Bench, attack: &str) -> PathBuf {
    let plugins = hostile(bench, "IN_ANSWER", attack);
    fly(bench, &plugins);
    bench.runs().pop().unwrap().join("crash-1")
}

#[test]
fn a_replay_judges_answers_as_the_console_does() {
    for (answer, why) in [
        ("out->a = 0.0 / 0.0", "gave a speed that is not a number"),
        ("out->a = 1.0 / 0.0", "gave a speed of inf m/s"),
        ("out->b = 1e308", "gave a turn rate of 1e308 rad/s"),
        ("out->status = 99", "status"),
        ("out->drive = 99", "drive"),
    ] {
        let bench = Bench::new();
        let bundle = bundle(&bench, answer);
        let about = std::fs::read_to_string(bundle.join("crash.txt")).unwrap();
        let fault = about.lines().next().unwrap();
        assert!(fault.contains(why), "{answer}: {about}");
        let plugin = bench.path().canonicalize().unwrap().join("hostile/libplanner_hostile.so");
        assert!(about.contains(&format!("plugin: {}\n", plugin.display())), "{about}");
        let replayed = bench.tankops(&["replay-worker", bundle.to_str().unwrap()]);
        let again = format!(" (step 3): {fault}\n");
        assert!(
            replayed.code == Some(1)
                && replayed.out.contains("failed again at request ")
                && replayed.out.ends_with(&again),
            "{answer}: {replayed:?}"
        );
    }
}

#[test]
fn a_replay_refuses_a_bundle_that_is_not_whole() {
    let bench = Bench::new();
    let bundle = bundle(&bench, "out->a = 1e308");
    let frames = std::fs::read(bundle.join("frames.bin")).unwrap();
    let about = std::fs::read(bundle.join("crash.txt")).unwrap();
    let replay = |changed: &[u8]| {
        std::fs::write(bundle.join("frames.bin"), changed).unwrap();
        bench.tankops(&["replay-worker", bundle.to_str().unwrap()])
    };
    let mut flipped = frames.clone();
    flipped[frames.len() / 2] ^= 1;
    for changed in [&[][..], &frames[..frames.len() - 1], &frames[..frames.len() / 2], &flipped] {
        let refused = replay(changed);
        let says = refused.err.contains("frames.bin was truncated or changed");
        assert!(refused.code == Some(2) && says, "{} bytes: {refused:?}", changed.len());
    }
    for missing in ["crash.txt", "frames.bin"] {
        std::fs::remove_file(bundle.join(missing)).unwrap();
        let refused = bench.tankops(&["replay-worker", bundle.to_str().unwrap()]);
        assert!(refused.code == Some(2) && refused.err.contains(missing), "{refused:?}");
        std::fs::write(bundle.join("crash.txt"), &about).unwrap();
    }
    std::fs::write(bundle.join("frames.bin"), &frames).unwrap();
    assert_eq!(bench.tankops(&["replay-worker", bundle.to_str().unwrap()]).code, Some(1));
}

#[test]
fn a_planner_that_gives_up_in_every_tank_fails_and_the_tanks_are_kept() {
    let bench = Bench::new();
    let plugins = hostile(&bench, "IN_ANSWER_ALWAYS", "return TP_E_INTERNAL");
    let plugin = plugins.join("libplanner_hostile.so");
    let tried = |more: &[&str]| {
        bench.tankops(&[&["check", plugin.to_str().unwrap(), "--fly", "2", "--seed", "7"], more].concat())
    };
    let checked = tried(&["--keep", "lost"]);
    let line = "FAIL  does not always give up: tank with seed 7: planner hostile gave up at step 0";
    assert!(checked.code == Some(1) && checked.out.contains(line), "{checked:?}");
    assert!(checked.out.contains("tank with seed 8: mission not completed ("), "{checked:?}");
    assert!(!checked.out.contains("continues from its saved state"), "it saves none: {checked:?}");
    for seed in [7, 8] {
        let kept = bench.path().join(format!("lost/hostile-goto-{seed}.toml"));
        let flown = bench.fly(&kept, &["--plugin-dir", plugins.to_str().unwrap()]);
        assert!(flown.json()["planner"] == "hostile" && flown.json()["seed"] == seed, "{flown:?}");
    }
    let json = tried(&["--json"]).json();
    let by_tank = json[0]["rows"][0]["by_tank"].as_array().unwrap();
    assert_eq!(by_tank.iter().map(|tank| tank["seed"].as_u64().unwrap()).collect::<Vec<_>>(), [7, 8]);
    assert!(by_tank[0]["failure"].as_str().is_some_and(|why| why.contains("gave up at step 0")), "{json}");
}

#[test]
fn a_check_blames_no_planner_for_the_crash_of_its_neighbour() {
    let bench = Bench::new();
    let folder = hostile(&bench, "IN_STEP", "abort()");
    let own = folder.join("libplanner_own.so");
    crate::faults::compile_file(&workspace().join("plugins/examples/direct-c/direct.c"), &own);
    // The first planner that is found.
    std::fs::rename(folder.join("libplanner_hostile.so"), folder.join("libplanner_a.so")).unwrap();
    let checked = bench.tankops(&["check", own.to_str().unwrap(), "--fly", "1"]);
    assert!(
        !checked.out.contains("FAIL") && checked.out.contains("ok    takes over during a mission"),
        "{checked:?}"
    );
}

#[test]
fn a_planner_that_shadows_another_one_is_named() {
    let bench = Bench::new();
    let source = std::fs::read_to_string(workspace().join("plugins/faulty/hostile.c")).unwrap();
    let source = bench.file("apf.c", source.replace("\"hostile\"", "\"apf\""));
    let folder = bench.path().join("own");
    std::fs::create_dir(&folder).unwrap();
    crate::faults::compile_file(&source, &folder.join("libplanner_mine.so"));
    let folder = folder.to_str().unwrap();
    let more = ["--no-record", "--set", "mission.time_limit_s=1", "--planner", "apf"];
    let plain = bench.fly(&scenario("goto-single-obstacle.toml"), &more);
    assert!(!plain.err.contains("is taken from"), "{plain:?}");
    let program = Path::new(env!("CARGO_BIN_EXE_tankops")).with_file_name("deps");
    let mut first = std::process::Command::new(env!("CARGO_BIN_EXE_tankops"));
    first.current_dir(bench.path()).args(["--plugin-dir", folder, "--plugin-dir"]).arg(program);
    first
        .arg("run")
        .arg(scenario("goto-single-obstacle.toml"))
        .args(more)
        .env("XDG_CACHE_HOME", bench.path());
    let flown = Ended::from(first.output().unwrap());
    let sentence = format!("planner apf is taken from {folder}/libplanner_mine.so; the one in ");
    assert!(flown.err.contains(&sentence), "{flown:?}");
}

#[test]
fn limits_of_the_machine_are_not_blamed_on_plugins() {
    let bench = Bench::new();
    let plugin = hostile(&bench, "IN_STEP", "").join("libplanner_hostile.so");
    let program = env!("CARGO_BIN_EXE_tankops");
    let limited = |limit: &str, words: &str| {
        let script = format!("ulimit {limit}; exec {program} {words}");
        let mut shell = std::process::Command::new("sh");
        shell
            .arg("-c")
            .arg(script)
            .current_dir(bench.path())
            .env("XDG_CACHE_HOME", bench.path().join("cache"));
        Ended::from(shell.output().unwrap())
    };
    let run = format!(
        "run {} --no-record --planner hostile --plugin-dir hostile",
        scenario("goto-single-obstacle.toml").display()
    );
    // Cached information about a plugin must not hide it.
    limited("-n 1024", &run);
    let words = [format!("check {}", plugin.display()), run];
    for words in &words {
        for (limit, says) in [("-n 201", "`ulimit -n 256`"), ("-f 1", "`ulimit -f ")] {
            let refused = limited(limit, words);
            assert!(refused.code == Some(3) && refused.err.contains(says), "{limit} {words}: {refused:?}");
        }
    }
}

/// Whether the console's group is the terminal's foreground group.
fn has_the_keyboard(console: i32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{console}/stat")).unwrap();
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    // Group and the terminal's foreground group.
    fields[2] == fields[5]
}

/// Attacks that continue, and attacks on keyboard or screen.
const LASTING: &[(&str, &str)] = &[
    ("IN_STEP", "for (;;);"),
    ("IN_STEP", "for (;;) rest(1000)"),
    ("IN_STEP", "kill(getpid(), SIGSTOP)"),
    ("IN_STEP", "raise(SIGTSTP)"),
    ("IN_STEP", "for (;;) { char *p = malloc(1 << 20); if (p) memset(p, 1, 1 << 20); }"),
    ("IN_STEP", "pthread_t t; for (int i = 0; i < 60; i++) pthread_create(&t, NULL, spin, NULL)"),
    ("IN_STEP", "pthread_t t; for (int i = 0; i < 4; i++) pthread_create(&t, NULL, prints, NULL)"),
    ("IN_STEP", "pthread_t t; for (int i = 0; i < 4; i++) pthread_create(&t, NULL, signals, NULL)"),
    ("IN_STEP", "pthread_t t; for (int i = 0; i < 4; i++) pthread_create(&t, NULL, asks, NULL)"),
    ("IN_STEP", "prints(NULL)"),
    ("IN_STEP", r#"for (;;) write(1, "\033[2J\033[?1049l\033c", 14)"#),
    ("IN_STEP", r#"for (;;) write(200, "\011\000\000\000\203\001\000\000\000\000\000\000\000", 13)"#),
    ("IN_STEP", r#"for (;;) write(200, "\377\377\377\000\200", 5)"#),
    ("IN_STEP", "for (int fd = 0; fd < 4096; fd++) close(fd)"),
    ("IN_STEP", "sigset_t all; sigfillset(&all); sigprocmask(SIG_BLOCK, &all, NULL); for (;;);"),
    ("IN_STEP", "kill(getppid(), SIGSTOP)"),
    ("IN_STEP", r#"open("/dev/tty", O_RDWR)"#),
    ("IN_STEP", "tcsetpgrp(0, getpid())"),
    ("IN_STEP", "ioctl(1, TIOCSTI, \"q\")"),
    ("IN_STEP", "if (fork() == 0) for (;;);"),
    ("IN_THREAD", "for (;;) write(200, \"x\", 1)"),
];

const HELPERS: &str = r#"
static void *spin(void *p) { for (;;); return p; }
static void *prints(void *p) { for (;;) write(2, "the quick brown fox jumps over the lazy dog\n", 44); return p; }
static void *asks(void *p) { for (;;) open("/proc/self/cgroup", O_RDONLY); return p; }
static void nothing(int s) { (void)s; }
static void *signals(void *p) { signal(SIGURG, nothing); for (;;) raise(SIGURG), kill(getpid(), SIGURG); return p; }
"#;

#[test]
fn the_console_hears_space_whatever_a_planner_does_for_long() {
    for (moment, attack) in LASTING {
        let attacks = Bench::new();
        let hostile_c = std::fs::read_to_string(workspace().join("plugins/faulty/hostile.c")).unwrap();
        let hostile_c =
            hostile_c.replacen("static void attack", &format!("{HELPERS}\nstatic void attack"), 1);
        let source =
            attacks.file("hostile.c", format!("#define {moment}\n#define ATTACK {attack}\n{hostile_c}"));
        crate::faults::compile_file(&source, &attacks.path().join("libplanner_hostile.so"));
        let (goto, plugins) = (scenario("goto-single-obstacle.toml"), attacks.path().display());
        let arguments = format!("--plugin-dir {plugins} console {} --planner hostile", goto.display());
        let mut session = Session::open(&arguments, 120, 36);
        session.see("IDLE");
        if *moment == "IN_THREAD" {
            // The planner attacks as soon as it is loaded: usually no plan exists, but its other thread may be faster.
            // The message names the plugin if the attack comes during loading, and the planner if it comes later.
            session.until("a fault or a plan", |session| {
                let text = session.text();
                text.contains("FAILED: pl") || text.contains("Press S to start")
            });
            if session.text().contains("FAILED: pl") {
                session.press("S");
                session.see("tart blocked");
                session.press_until("1", "[1 Home]");
                session.press("q");
                assert_eq!(session.back_in_the_shell(), "code=0", "{attack}");
                continue;
            }
        }
        session.start();
        session.until("the attack", |session| {
            let runs = session.bench.runs();
            let flown = runs.iter().find(|run| run.join(recording::JOURNAL_FILE).exists());
            flown.is_some_and(|run| of_kind(&journal(run), "truth").len() > 8)
        });
        session.press(" ");
        // If the fault already holds the robot, the key asks whether to resume.
        session.until(&format!("space to be heard: {attack}"), |session| {
            let events = journal(&session.run());
            let is_ordered = of_kind(&events, "ordered").iter().any(|event| event["order"] == "hold");
            is_ordered || session.text().contains("Resume?")
        });
        session
            .until("the robot to be held", |session| !of_kind(&journal(&session.run()), "held").is_empty());
        assert!(has_the_keyboard(session.console_pid()), "{attack}");
        // Closes any open question on the way.
        session.press("\x1b");
        session.press_until("1", "[1 Home]");
        session.press("q");
        assert_eq!(session.agree_to_leave(), "code=1", "{attack}");
    }
}

#[test]
fn a_plan_that_the_mission_refuses_for_its_tank_is_no_difference() {
    let bench = Bench::new();
    let source = std::fs::read_to_string(workspace().join("plugins/faulty/hostile.c")).unwrap();
    let end = "out->cost = 0.0;";
    assert!(source.contains(end));
    let far = format!("const tp_vec2 far = {{1e5, 0.0}}; h->points(h->ctx, &far, 1); {end}");
    let source = bench.file("far.c", format!("#define IN_STEP\n{}", source.replacen(end, &far, 1)));
    let plugins = bench.path().join("far");
    std::fs::create_dir(&plugins).unwrap();
    crate::faults::compile_file(&source, &plugins.join("libplanner_hostile.so"));
    let flown = fly(&bench, &plugins);
    assert!(flown.out.contains("is far outside the tank"), "{flown:?}");
    bench.prove_with(&bench.runs()[0], &["--plugin-dir", plugins.to_str().unwrap()]);
}

#[test]
fn a_planner_that_fails_only_while_it_is_verified_makes_a_run_neither_equal_nor_different() {
    let bench = Bench::new();
    // The only environment variables that a planner receives from the console.
    let attack = r#"if (getenv("RUST_BACKTRACE") && *getenv("RUST_BACKTRACE") == 'f') abort()"#;
    let plugins = hostile(&bench, "IN_STEP", attack);
    let more = ["--planner", "hostile", "--set", "mission.time_limit_s=2", "--plugin-dir"];
    let plugins = plugins.to_str().unwrap();
    bench.fly(&scenario("goto-single-obstacle.toml"), &[&more[..], &[plugins]].concat());
    let run = bench.runs().pop().unwrap();
    bench.prove_with(&run, &["--plugin-dir", plugins]);
    let mut verify = bench.command();
    verify.env("RUST_BACKTRACE", "full").arg("verify").arg(&run).args(["--plugin-dir", plugins]);
    let verified = Ended::from(verify.output().unwrap());
    assert_eq!(verified.code, Some(1), "{verified:?}");
    let sentence = "not proven: at ask ";
    assert!(verified.out.contains(sentence) && !verified.out.contains("different"), "{verified:?}");
    assert!(verified.out.contains("SIGABRT") && !verified.out.contains("equal:"), "{verified:?}");
}

#[test]
fn what_is_no_regular_file_is_no_plugin_and_is_not_waited_for() {
    let bench = Bench::new();
    for name in ["planner.so", "libplanner_pipe.so"] {
        let pipe = bench.path().join(name);
        rustix::fs::mkfifoat(rustix::fs::CWD, &pipe, rustix::fs::Mode::RWXU).unwrap();
        let checked = bench.tankops(&["check", pipe.to_str().unwrap()]);
        assert!(checked.code == Some(2) && checked.err.contains("not a regular file"), "{checked:?}");
    }
    let listed = bench.tankops(&["--plugin-dir", ".", "planners"]);
    assert!(
        listed.out.contains("not a regular file") || listed.err.contains("not a regular file"),
        "{listed:?}"
    );
    // The kernel's log has no end; on some machines, the user may not open it.
    let endless = bench.tankops(&["check", "/proc/kmsg"]);
    assert_eq!(endless.code, Some(2), "{endless:?}");
}
