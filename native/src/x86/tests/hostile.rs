//! Called functions that leave rubbish in every register that a function may change.
#![expect(unsafe_code, reason = "registers are written by assembly")]

use std::arch::asm;
use std::mem::transmute;

use crate::memory::called::address;
use crate::straight::graph::Function;

const FUNCTIONS: [Function; 4] = [Function::Exp, Function::Ln, Function::Atan2, Function::MulAdd];

type Called = unsafe extern "sysv64" fn(*mut f64, *const f64, *const f64, *const f64);

/// The function that stands in for another.
pub(super) fn hostile<const LANES: usize>(function: Function) -> usize {
    match function {
        Function::Exp => stands_for::<LANES, 0> as *const () as usize,
        Function::Ln => stands_for::<LANES, 1> as *const () as usize,
        Function::Atan2 => stands_for::<LANES, 2> as *const () as usize,
        Function::MulAdd => stands_for::<LANES, 3> as *const () as usize,
    }
}

unsafe extern "sysv64" fn stands_for<const LANES: usize, const FUNCTION: usize>(
    result: *mut f64,
    a: *const f64,
    b: *const f64,
    c: *const f64,
) {
    let real = address::<LANES>(FUNCTIONS[FUNCTION]) as *const ();
    // SAFETY: the address of a function of this convention, which reads as many arguments as it has.
    let real = unsafe { transmute::<*const (), Called>(real) };
    // SAFETY: arguments are handed on as they came.
    unsafe { real(result, a, b, c) };
    // SAFETY: registers that a function of this convention may change, told to the compiler.
    unsafe {
        asm!(
            "vpcmpeqd xmm0, xmm0, xmm0",
            "vpcmpeqd xmm1, xmm1, xmm1",
            "vpcmpeqd xmm2, xmm2, xmm2",
            "vpcmpeqd xmm3, xmm3, xmm3",
            "vpcmpeqd xmm4, xmm4, xmm4",
            "vpcmpeqd xmm5, xmm5, xmm5",
            "vpcmpeqd xmm6, xmm6, xmm6",
            "vpcmpeqd xmm7, xmm7, xmm7",
            "vpcmpeqd xmm8, xmm8, xmm8",
            "vpcmpeqd xmm9, xmm9, xmm9",
            "vpcmpeqd xmm10, xmm10, xmm10",
            "vpcmpeqd xmm11, xmm11, xmm11",
            "vpcmpeqd xmm12, xmm12, xmm12",
            "vpcmpeqd xmm13, xmm13, xmm13",
            "vpcmpeqd xmm14, xmm14, xmm14",
            "vpcmpeqd xmm15, xmm15, xmm15",
            "mov rax, -1",
            "mov rcx, -1",
            "mov rdx, -1",
            "mov rsi, -1",
            "mov rdi, -1",
            "mov r8, -1",
            "mov r9, -1",
            "mov r10, -1",
            "mov r11, -1",
            clobber_abi("sysv64"),
        );
    }
    if is_x86_feature_detected!("avx512f") {
        // SAFETY: as above; nothing of this function lives in the upper half.
        unsafe {
            asm!(
                "kxnorw k1, k1, k1",
                "kxorw k2, k2, k2",
                "kxnorw k3, k3, k3",
                "kxorw k4, k4, k4",
                "kxnorw k5, k5, k5",
                "kxorw k6, k6, k6",
                "kxnorw k7, k7, k7",
                "vpternlogd zmm16, zmm16, zmm16, 255",
                "vpternlogd zmm17, zmm17, zmm17, 255",
                "vpternlogd zmm18, zmm18, zmm18, 255",
                "vpternlogd zmm19, zmm19, zmm19, 255",
                "vpternlogd zmm20, zmm20, zmm20, 255",
                "vpternlogd zmm21, zmm21, zmm21, 255",
                "vpternlogd zmm22, zmm22, zmm22, 255",
                "vpternlogd zmm23, zmm23, zmm23, 255",
                "vpternlogd zmm24, zmm24, zmm24, 255",
                "vpternlogd zmm25, zmm25, zmm25, 255",
                "vpternlogd zmm26, zmm26, zmm26, 255",
                "vpternlogd zmm27, zmm27, zmm27, 255",
                "vpternlogd zmm28, zmm28, zmm28, 255",
                "vpternlogd zmm29, zmm29, zmm29, 255",
                "vpternlogd zmm30, zmm30, zmm30, 255",
                "vpternlogd zmm31, zmm31, zmm31, 255",
                clobber_abi("sysv64"),
            );
        }
    }
}
