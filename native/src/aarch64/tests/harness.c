/* Runs functions of machine code on their inputs, and writes what they give. In: a file of cases. Out: a file of results.
   It checks on the way what a caller relies on: kept registers, the stack, memory that is only read, pages that nobody may
   touch. What the code calls answers from the case's list, and leaves rubbish wherever it may.

   A case, in 64-bit words: lengths in words of code, constants, inputs, outputs, workspace; passes; words from pass to
   pass; number of calls; lanes; then code, constants, inputs, and of every call function, three arguments, result. */

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define PAGE 4096

static void fail(const char *what, uint64_t number) {
    fprintf(stderr, "%s: %llx\n", what, (unsigned long long)number);
    exit(1);
}

/* Words that end right before a page that nobody may touch. */
typedef struct {
    char *base;
    size_t pages;
    uint64_t *words;
} Guarded;

static Guarded guarded(size_t count) {
    size_t pages = count * 8 / PAGE + 1;
    char *base = mmap(NULL, (pages + 1) * PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (base == MAP_FAILED) fail("no memory", count);
    if (mprotect(base + pages * PAGE, PAGE, PROT_NONE)) fail("no guard", count);
    return (Guarded){base, pages, (uint64_t *)(base + pages * PAGE) - count};
}

static void protect(Guarded guarded, int rights) {
    if (mprotect(guarded.base, guarded.pages * PAGE, rights)) fail("no protection", rights);
}

static void release(Guarded guarded) { munmap(guarded.base, (guarded.pages + 1) * PAGE); }

static FILE *in;

static void take(void *to, size_t count) {
    if (fread(to, 8, count, in) != count) fail("the file ends", count);
}

typedef struct {
    uint64_t function, arguments[3], result;
} Call;

static Call *calls;
static uint64_t call_count, lanes;

/* Bits and payloads of NaN are nobody's promise. */
static uint64_t same_nan(uint64_t bits) {
    double number;
    memcpy(&number, &bits, 8);
    return isnan(number) ? 0x7FF8000000000000 : bits;
}

void answer(uint64_t *result, const uint64_t *a, const uint64_t *b, const uint64_t *c, uint64_t function) {
    const uint64_t *arguments[3] = {a, b, c};
    const int counts[4] = {1, 1, 2, 3};
    for (uint64_t lane = 0; lane < lanes; lane++) {
        uint64_t at = 0;
        for (; at < call_count; at++) {
            int same = calls[at].function == function;
            for (int i = 0; same && i < counts[function]; i++)
                same = calls[at].arguments[i] == same_nan(arguments[i][lane]);
            if (same) break;
        }
        if (at == call_count) fail("a call that is not on the list", function);
        result[lane] = calls[at].result;
    }
}

void called_0(void);
void called_1(void);
void called_2(void);
void called_3(void);

__asm__(
    /* What a function may change: x0 to x17, v0 to v7, v16 to v31, the upper halves of v8 to v15. */
    "leave_rubbish:\n"
    ".irp n, 0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17\n mov x\\n, #-1\n.endr\n"
    ".irp n, 0,1,2,3,4,5,6,7,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31\n movi v\\n\\().2d, #-1\n.endr\n"
    ".irp n, 8,9,10,11,12,13,14,15\n ins v\\n\\().d[1], x0\n.endr\n"
    "ret\n"
    ".macro called number\n"
    ".global called_\\number\n"
    "called_\\number:\n"
    "stp x29, x30, [sp, #-16]!\n"
    "mov x4, #\\number\n"
    "bl answer\n"
    "bl leave_rubbish\n"
    "ldp x29, x30, [sp], #16\n"
    "ret\n"
    ".endm\n"
    "called 0\ncalled 1\ncalled 2\ncalled 3\n"

    /* checked(code, input, output, constants, workspace): how many of the kept registers are not as they were. */
    ".macro pattern number, to\n mov \\to, #0xAB00\n add \\to, \\to, #\\number\n.endm\n"
    ".macro check number, from\n pattern \\number, x1\n cmp x1, \\from\n cinc x0, x0, ne\n.endm\n"
    ".global checked\n"
    "checked:\n"
    "stp x29, x30, [sp, #-176]!\n"
    "stp x19, x20, [sp, #16]\nstp x21, x22, [sp, #32]\nstp x23, x24, [sp, #48]\n"
    "stp x25, x26, [sp, #64]\nstp x27, x28, [sp, #80]\n"
    "stp d8, d9, [sp, #96]\nstp d10, d11, [sp, #112]\nstp d12, d13, [sp, #128]\nstp d14, d15, [sp, #144]\n"
    "adrp x9, stack\nmov x10, sp\nstr x10, [x9, #:lo12:stack]\n"
    "mov x9, x0\nmov x0, x1\nmov x1, x2\nmov x2, x3\nmov x3, x4\n"
    ".irp n, 19,20,21,22,23,24,25,26,27,28,29\n pattern \\n, x\\n\n.endr\n"
    ".irp n, 8,9,10,11,12,13,14,15\n pattern \\n, x10\n fmov d\\n, x10\n.endr\n"
    "blr x9\n"
    "mov x0, #0\n"
    ".irp n, 19,20,21,22,23,24,25,26,27,28,29\n check \\n, x\\n\n.endr\n"
    ".irp n, 8,9,10,11,12,13,14,15\n fmov x2, d\\n\n check \\n, x2\n.endr\n"
    "adrp x9, stack\nldr x10, [x9, #:lo12:stack]\nmov x1, sp\ncmp x1, x10\ncinc x0, x0, ne\n"
    "mov sp, x10\n"
    "ldp x19, x20, [sp, #16]\nldp x21, x22, [sp, #32]\nldp x23, x24, [sp, #48]\n"
    "ldp x25, x26, [sp, #64]\nldp x27, x28, [sp, #80]\n"
    "ldp d8, d9, [sp, #96]\nldp d10, d11, [sp, #112]\nldp d12, d13, [sp, #128]\nldp d14, d15, [sp, #144]\n"
    "ldp x29, x30, [sp], #176\n"
    "ret\n"
    ".lcomm stack, 8\n");

uint64_t checked(void *code, const uint64_t *input, uint64_t *output, const uint64_t *pool, uint64_t *workspace);

/* Jumps at the addresses that the code takes for those of functions. */
static void place_functions(uint64_t address) {
    void (*functions[4])(void) = {called_0, called_1, called_2, called_3};
    void *page = mmap((void *)address, PAGE, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0);
    if (page != (void *)address) fail("no page for functions", address);
    for (int i = 0; i < 4; i++) {
        /* ldr x17, [pc, #8]; br x17. */
        uint32_t jump[2] = {0x58000051, 0xD61F0220};
        memcpy((char *)page + 16 * i, jump, 8);
        memcpy((char *)page + 16 * i + 8, &functions[i], 8);
    }
    __builtin___clear_cache((char *)page, (char *)page + PAGE);
    if (mprotect(page, PAGE, PROT_READ | PROT_EXEC)) fail("no executable memory", address);
}

int main(int count, char **arguments) {
    if (count != 4) fail("cases, results, address of functions", count);
    in = fopen(arguments[1], "rb");
    FILE *out = fopen(arguments[2], "wb");
    if (!in || !out) fail("no file", 0);
    place_functions(strtoull(arguments[3], NULL, 16));
    uint64_t head[9];
    for (uint64_t number = 0; fread(head, 8, 9, in) == 9; number++) {
        Guarded code = guarded(head[0]), pool = guarded(head[1]), input = guarded(head[2]);
        Guarded output = guarded(head[3]), workspace = guarded(head[4]);
        call_count = head[7];
        lanes = head[8];
        take(code.words, head[0]);
        take(pool.words, head[1]);
        take(input.words, head[2]);
        calls = malloc(call_count * sizeof(Call) + 1);
        take(calls, 5 * call_count);
        memset(output.words, 0xFF, 8 * head[3]);
        memset(workspace.words, 0xFF, 8 * head[4]);
        __builtin___clear_cache((char *)code.words, (char *)(code.words + head[0]));
        protect(code, PROT_READ | PROT_EXEC);
        protect(pool, PROT_READ);
        protect(input, PROT_READ);
        for (uint64_t pass = 0; pass < head[5]; pass++) {
            uint64_t further = pass * head[6];
            if (checked(code.words, input.words + further, output.words + further, pool.words, workspace.words))
                fail("registers or stack are not as they were, in case", number);
        }
        if (fwrite(output.words, 8, head[3], out) != head[3]) fail("no results", number);
        free(calls);
        release(code), release(pool), release(input), release(output), release(workspace);
    }
    return fclose(out);
}
