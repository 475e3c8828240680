//! Files that are not valid plugins are refused with the reason, and no other plugin is affected.

use crate::stand::{assert_refused, built, choose, compile, config, direct_c, folder_with, worker};
use mission::planner::Parameters;
use planner_host::{BlockingHost, PluginDirs, Survey, Surveyor, WorkerCommand, survey};
use std::path::Path;

fn refusal(dirs: &PluginDirs) -> String {
    let found = survey(dirs, &worker());
    assert_eq!(found.planners().count(), 0);
    found.plugins[0].refused.clone().unwrap()
}

fn file(name: &str, content: &[u8]) -> (tempfile::TempDir, PluginDirs) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), content).unwrap();
    let dirs = PluginDirs::of(vec![folder.path().to_owned()]);
    (folder, dirs)
}

#[test]
fn a_text_file_is_no_library() {
    let (_folder, dirs) = file("libplanner_text.so", b"not a library\n");
    assert_eq!(refusal(&dirs), "not a shared library");
    let fault = choose(&mut BlockingHost::new(&dirs, config()), "text", &Parameters::new()).unwrap_err();
    assert_refused(&fault, &["planner text", "libplanner_text.so", "not a shared library"]);
}

#[test]
fn a_truncated_library_is_damaged() {
    let whole = built().plugins().into_iter().find(|plugin| plugin.name().contains("faulty")).unwrap();
    let bytes = std::fs::read(whole.path).unwrap();
    let (_folder, dirs) = file("libplanner_cut.so", &bytes[..5000]);
    assert!(refusal(&dirs).starts_with("truncated or damaged library"));
}

#[test]
fn a_library_without_a_stamp_is_no_plugin() {
    let (_folder, dirs) = folder_with("plain", "int answer(void);\nint answer(void) { return 42; }\n");
    let why = refusal(&dirs);
    assert!(why.starts_with("a library, but not a planner plugin (no .tankplan stamp"), "{why}");
}

#[test]
fn a_library_that_it_needs_and_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let nothing = folder.path().join("libgone.so");
    let mut cc = std::process::Command::new("cc");
    cc.args(["-shared", "-Wl,-soname,libgone.so", "-o"]).arg(&nothing).args(["-x", "c", "/dev/null"]);
    assert!(cc.status().unwrap().success());
    let (source, needed) = (direct_c(), ["-Wl,--no-as-needed".as_ref(), nothing.as_os_str()]);
    crate::stand::compile_with(&source, folder.path(), "needs", &[], &needed);
    std::fs::remove_file(&nothing).unwrap();
    let why = refusal(&PluginDirs::of(vec![folder.path().to_owned()]));
    assert!(why.starts_with("the loader refused it: ") && why.contains("libgone.so"), "{why}");
}

#[test]
fn another_abi_is_refused_before_anything_of_it_runs() {
    // Its constructor would crash the worker: the message shows that it was not loaded.
    let source = "#include \"tankops_planner.h\"\nTP_STAMP(9, 0);\n\
                  __attribute__((constructor)) static void boom(void) { *(volatile int *)8 = 1; }\n";
    let (_folder, dirs) = folder_with("newer", source);
    assert_eq!(refusal(&dirs), "built for planner ABI 9.0; this console uses 1.5: update the console");
    let (_folder, dirs) = folder_with("older", &source.replace("9, 0", "0, 4"));
    assert_eq!(refusal(&dirs), "built for planner ABI 0.4; this console uses 1.5: rebuild the plugin");
}

const HEAD: &str = "#include \"tankops_planner.h\"\nTP_STAMP(TP_ABI_MAJOR, TP_ABI_MINOR);\n";

#[test]
fn a_stamp_alone_is_no_plugin() {
    let (_folder, dirs) = folder_with("stamp", HEAD);
    assert_eq!(refusal(&dirs), "does not export `tank_planner_entry`");
}

#[test]
fn a_planner_without_its_functions_is_refused_with_their_names() {
    let source = format!(
        "{HEAD}static const tp_planner p = {{ sizeof(tp_planner), TP_CAP_LOCAL, 1, 0, TP_STR(\"half\"), TP_STR(\"Half\"), \
         TP_STR(\"1\"), TP_STR(\"\"), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 }};\n\
         static const tp_planner *const list[] = {{ &p }};\n\
         TP_EXPORT const tp_entry tank_planner_entry = TP_ENTRY(list, 1, \"C\");\n"
    );
    let (_folder, dirs) = folder_with("half", &source);
    assert_eq!(
        refusal(&dirs),
        "planner `half` lacks required functions: describe, create, destroy, plan, step"
    );
    let fault = choose(&mut BlockingHost::new(&dirs, config()), "half", &Parameters::new()).unwrap_err();
    assert_refused(&fault, &["plugin libplanner_half.so is refused", "lacks required functions"]);
}

#[test]
fn an_entry_of_a_broken_header_is_refused() {
    let source = format!(
        "{HEAD}static const tp_planner *const list[1] = {{ 0 }};\n\
         TP_EXPORT const tp_entry tank_planner_entry = {{ TP_MAGIC, 1, 0, 12, 1, list, TP_STR(\"C\") }};\n"
    );
    let (_folder, dirs) = folder_with("small", &source);
    assert!(refusal(&dirs).starts_with("its entry has 12 bytes, but ABI 1.5 needs 48"));
    let (_folder, dirs) = folder_with("null", &source.replace(" 12,", " sizeof(tp_entry),"));
    assert_eq!(refusal(&dirs), "planner number 0 is null");
}

#[test]
fn a_missing_symbol_is_found_when_the_library_is_loaded() {
    let source = format!(
        "{HEAD}extern int no_such_function(void);\nint f(void);\nint f(void) {{ return no_such_function(); }}\n"
    );
    let (_folder, dirs) = folder_with("undefined", &source);
    let why = refusal(&dirs);
    assert!(why.starts_with("the loader refused it") && why.contains("no_such_function"), "{why}");
    assert!(!why.contains("/proc") && !why.contains("/tmp"), "no path of this machine: {why}");
}

#[test]
fn a_library_that_crashes_while_it_is_loaded_is_a_line_in_the_list() {
    let source =
        format!("{HEAD}__attribute__((constructor)) static void boom(void) {{ *(volatile int *)8 = 1; }}\n");
    let (_folder, dirs) = folder_with("crash", &source);
    assert_eq!(refusal(&dirs), "was killed by SIGSEGV (invalid memory access) while being loaded");
}

#[test]
fn a_library_that_never_finishes_loading_is_a_line_in_the_list() {
    let source = format!("{HEAD}__attribute__((constructor)) static void spin(void) {{ for (;;) {{ }} }}\n");
    let (_folder, dirs) = folder_with("spin", &source);
    assert_eq!(refusal(&dirs), "did not load in time; its process was stopped");
}

#[test]
fn the_first_planner_of_an_id_wins_and_later_ones_are_shadowed() {
    let (first, second) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    compile(&direct_c(), first.path(), "one", &[]);
    // A different macro gives a different file with the same planner.
    compile(&direct_c(), second.path(), "two", &["PI2=1", "NDEBUG"]);
    let other = std::fs::read(second.path().join("libplanner_two.so")).unwrap();
    std::fs::write(second.path().join("libplanner_two.so"), [other, vec![0]].concat()).unwrap();
    let dirs = PluginDirs::of([&first, &second].map(|folder| folder.path().to_owned()).into());
    let found = survey(&dirs, &worker());
    assert_eq!((found.plugins[0].planners.len(), found.plugins[1].planners.len()), (1, 0));
    assert_eq!(found.plugins[1].shadowed, ["direct-c"]);
    let info = choose(&mut BlockingHost::new(&dirs, config()), "direct-c", &Parameters::new()).unwrap();
    assert_eq!(info.plugin, "libplanner_one.so");
}

#[test]
fn a_bad_file_does_not_hide_a_good_one() {
    let folder = tempfile::tempdir().unwrap();
    compile(&direct_c(), folder.path(), "good", &[]);
    // This file names the same planner, comes first and cannot be loaded.
    let bad =
        format!("{HEAD}const char *direct_c(void);\nconst char *direct_c(void) {{ return \"direct-c\"; }}\n");
    let source = folder.path().join("bad.c");
    std::fs::write(&source, bad).unwrap();
    compile(&source, folder.path(), "bad", &[]);
    let dirs = PluginDirs::of(vec![folder.path().to_owned()]);
    let info = choose(&mut BlockingHost::new(&dirs, config()), "direct-c", &Parameters::new()).unwrap();
    assert_eq!(info.plugin, "libplanner_good.so");
}

#[test]
fn a_planner_that_is_not_there_names_the_nearest_one() {
    let (folder, dirs) =
        (tempfile::tempdir().unwrap(), |folder: &Path| PluginDirs::of(vec![folder.to_owned()]));
    let mut empty = BlockingHost::new(&dirs(folder.path()), config());
    let fault = choose(&mut empty, "apf", &Parameters::new()).unwrap_err();
    assert_refused(&fault, &["no plugin has the planner apf", "contain no plugins"]);
    compile(&direct_c(), folder.path(), "direct_c", &[]);
    let fault = choose(&mut empty, "direkt-c", &Parameters::new()).unwrap_err();
    assert_refused(&fault, &["did you mean `direct-c`?"]);
    choose(&mut empty, "direct-c", &Parameters::new()).expect("a plugin that was built meanwhile is found");
}

#[test]
fn a_survey_can_be_written_down() {
    let found: Survey = survey(&built(), &worker());
    let faulty = found.planners().find(|info| info.id == "faulty").unwrap();
    assert_eq!((faulty.plugin.starts_with("libplanner_faulty."), faulty.abi.as_str()), (true, "1.5"));
    let json = serde_json::to_string(&found).unwrap();
    assert!(json.contains("\"faulty\"") && json.contains(&faulty.sha256));
}

#[test]
fn a_machine_without_workers_is_not_a_fault_of_plugins() {
    let (dirs, sound, none) = (built(), worker(), WorkerCommand::new("/nowhere/worker"));
    let surveyor = |worker| {
        let surveyor = Surveyor::new(&dirs, worker);
        surveyor.survey();
        surveyor.no_worker()
    };
    assert_eq!(surveyor(&sound), None);
    let why = surveyor(&none).expect("no process is started");
    assert!(why.starts_with("cannot be run: its process cannot be started: No such file"), "{why}");
}
