/* Preloaded into a process, watches one of its threads: what it allocates, frees and locks is written down, and so is
   its first system call, after which it goes no further. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <execinfo.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#define DEPTH 40

/* Whether the calling thread is watched. */
static __thread int watched;

/* What was seen: how often, and of the first what it was and who called. */
static volatile int offences;
static const char *first_name;
static long first_number;
static void *first_callers[DEPTH];
static int first_depth;

static void offend(const char *name, long number) {
    if (!watched) return;
    watched = 0; /* Writing down must not be written down. */
    if (offences == 0) {
        first_name = name;
        first_number = number;
        first_depth = backtrace(first_callers, DEPTH);
    }
    __atomic_add_fetch(&offences, 1, __ATOMIC_SEQ_CST);
    watched = 1;
}

/* The filter refuses every system call; the thread stays here, since it could not even return. */
static void refused(int signal, siginfo_t *info, void *context) {
    (void)signal;
    (void)context;
    watched = 1;
    offend("a system call", info->si_syscall);
    for (;;) {
    }
}

/* From here on nothing that the calling thread does goes unseen, until the process ends. Returns 0 or says that the
   kernel cannot do this. */
int sprung_watch(void) {
    void *warm[4];
    backtrace(warm, 4); /* Its first call loads a library. */
    struct sigaction action = {0};
    action.sa_sigaction = refused;
    action.sa_flags = SA_SIGINFO;
    if (sigaction(SIGSYS, &action, NULL) != 0) return -1;
    struct sock_filter refuse_all[] = {BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP)};
    struct sock_fprog program = {.len = 1, .filter = refuse_all};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return -1;
    watched = 1;
    if (syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program) != 0) {
        watched = 0;
        return -1;
    }
    return 0;
}

/* Called by another thread: how much was seen. The first of it is described on stderr. */
int sprung_watch_offences(void) {
    int seen = __atomic_load_n(&offences, __ATOMIC_SEQ_CST);
    if (seen > 0) {
        fprintf(stderr, "%d offences; the first is %s (%ld), from:\n", seen, first_name, first_number);
        backtrace_symbols_fd(first_callers, first_depth, STDERR_FILENO);
    }
    return seen;
}

/* Allocation. glibc's own names spare a search for the next definition, which would itself allocate. */
extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);
extern void __libc_free(void *);

void *malloc(size_t size) {
    offend("malloc", (long)size);
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
    offend("calloc", (long)(count * size));
    return __libc_calloc(count, size);
}

void *realloc(void *old, size_t size) {
    offend("realloc", (long)size);
    return __libc_realloc(old, size);
}

void *memalign(size_t alignment, size_t size) {
    offend("memalign", (long)size);
    return __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
    offend("aligned_alloc", (long)size);
    return __libc_memalign(alignment, size);
}

int posix_memalign(void **result, size_t alignment, size_t size) {
    offend("posix_memalign", (long)size);
    *result = __libc_memalign(alignment, size);
    return *result ? 0 : 12;
}

void free(void *memory) {
    if (memory) offend("free", 0);
    __libc_free(memory);
}

/* Locks of the system's library. Those that Rust builds on atomic operations show as a system call when they wait. */
#define LOCK(name, type)                                                     \
    int name(type *lock) {                                                   \
        static int (*next)(type *);                                          \
        offend(#name, 0);                                                    \
        if (!next) next = (int (*)(type *))dlsym(RTLD_NEXT, #name);          \
        return next(lock);                                                   \
    }

LOCK(pthread_mutex_lock, pthread_mutex_t)
LOCK(pthread_mutex_trylock, pthread_mutex_t)
LOCK(pthread_rwlock_rdlock, pthread_rwlock_t)
LOCK(pthread_rwlock_wrlock, pthread_rwlock_t)
LOCK(pthread_spin_lock, pthread_spinlock_t)
LOCK(sem_wait, sem_t)
