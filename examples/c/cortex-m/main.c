/* A thousand steps of the RSSR on a Cortex-M without an operating system: its state as bits, its stack, its instructions. Output by
 * semihosting, which emulators and debug probes understand. */
#include <stdint.h>

#include "rssr_rigid.h"

extern uint32_t stack_begin[], stack_end[], data_begin[], data_end[], data_load[], bss_begin[], bss_end[];

#define SYSTICK_CONTROL (*(volatile uint32_t *)0xE000E010u)
#define SYSTICK_RELOAD (*(volatile uint32_t *)0xE000E014u)
#define SYSTICK_VALUE (*(volatile uint32_t *)0xE000E018u)

static int ask_host(int operation, const void *argument)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static void write_hex(const char *name, uint64_t value, int digits)
{
    char text[20];
    int i;
    for (i = 0; i < digits; ++i) {
        text[i] = "0123456789abcdef"[(value >> (4 * (digits - 1 - i))) & 15];
    }
    text[digits] = '\n';
    text[digits + 1] = 0;
    ask_host(4, name);
    ask_host(4, text);
}

static void turn(void)
{
    double parameters[RSSR_RIGID_PARAMETERS];
    double y[RSSR_RIGID_STATE] = {0.0};
    rssr_rigid_memory memory;
    int i, status;
    uint32_t begin;
    rssr_rigid_set_parameters(&rssr_rigid_default_parameters, parameters);
    for (i = 0; i < RSSR_RIGID_COORDINATES + RSSR_RIGID_SPEEDS; ++i) {
        y[i] = rssr_rigid_start_state[i];
    }
    status = rssr_rigid_begin(parameters, 0.0, y, &memory);
    begin = SYSTICK_VALUE;
    for (i = 0; status == RSSR_RIGID_DONE && i < 1000; ++i) {
        status = rssr_rigid_rk4_step(parameters, i * 1e-4, 1e-4, y, &memory);
    }
    write_hex("ticks ", (begin - SYSTICK_VALUE) & 0xffffffu, 8);
    write_hex("status ", (uint64_t)status, 2);
    for (i = 0; i < RSSR_RIGID_STATE; ++i) {
        union {
            double number;
            uint64_t bits;
        } value;
        value.number = y[i];
        write_hex("y ", value.bits, 16);
    }
}

void reset(void)
{
    uint32_t *from, *to;
    for (from = data_load, to = data_begin; to < data_end;) {
        *to++ = *from++;
    }
    for (to = bss_begin; to < bss_end;) {
        *to++ = 0;
    }
    /* What is never overwritten was never used; the last words are this function's own. */
    for (to = stack_begin; to < stack_end - 64; ++to) {
        *to = 0x5eedf00du;
    }
    SYSTICK_RELOAD = 0xffffffu;
    SYSTICK_VALUE = 0;
    SYSTICK_CONTROL = 5;
    turn();
    for (to = stack_begin; *to == 0x5eedf00du;) {
        ++to;
    }
    write_hex("stack ", (uint64_t)(stack_end - to) * 4, 8);
    ask_host(0x18, (const void *)0x20026);
    for (;;) {
    }
}

__attribute__((section(".vectors"), used)) static void (*const vectors[2])(void) = {(void (*)(void))stack_end, reset};
