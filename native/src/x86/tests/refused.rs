//! A system that gives no executable memory: Linux under `PR_SET_MDWE`, as services with `MemoryDenyWriteExecute` are.
#![cfg(target_os = "linux")]
#![expect(unsafe_code, reason = "the flag is set by a system call")]

use std::env;
use std::process::Command;

use crate::memory::code::Code;
use crate::refusal::Refusal;
use crate::straight::write::Written;

/// Set where this test runs itself again, since the flag cannot be taken back.
const INSIDE: &str = "LINKWEAR_TEST_WITHOUT_EXECUTABLE_MEMORY";
const PR_SET_MDWE: libc::c_int = 65;
const PR_MDWE_REFUSE_EXEC_GAIN: libc::c_ulong = 1;
/// Said where the kernel is older than the flag (6.3).
const OLD: &str = "this kernel cannot refuse";

#[test]
fn refused_memory_is_a_reason_and_no_crash() {
    let name = "x86::tests::refused::inside_a_hardened_process";
    let this = env::current_exe().expect("the test itself");
    let arguments = [name, "--exact", "--ignored", "--nocapture"];
    let output = Command::new(this).args(arguments).env(INSIDE, "1").output().expect("runs");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.contains("refused: ") || text.contains(OLD), "{text}");
}

#[test]
#[ignore = "run by the test before, in a process of its own"]
fn inside_a_hardened_process() {
    assert!(env::var_os(INSIDE).is_some(), "it hardens the whole process");
    let returns = || Written {
        code: vec![0xC3],
        pool: vec![],
        inputs: 0,
        outputs: 0,
        workspace: 0,
        slack: 0,
        passes: 1,
        advance: 1,
        columns: false,
    };
    let given = Code::new(vec![returns()]).expect("memory, as long as nothing forbids it");
    given.run(0, &[], &mut [], &mut []);
    // SAFETY: a flag of this process.
    let answer = unsafe { libc::prctl(PR_SET_MDWE, PR_MDWE_REFUSE_EXEC_GAIN, 0_u64, 0_u64, 0_u64) };
    if answer != 0 {
        println!("{OLD}");
        return;
    }
    match Code::new(vec![returns()]) {
        Err(refusal @ Refusal::Memory { .. }) => println!("refused: {refusal}"),
        other => panic!("{other:?}"),
    }
}
