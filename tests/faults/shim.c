/* Fails chosen calls of libc, or records them: preloaded into a command and the processes that it starts.
 *
 * A call counts if it concerns a path below the root, or if it starts a process or sends to one. The control is a file
 * that all processes map: tests/faults/shim.py describes its layout. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum { OPEN, READ, WRITE, SYNC, RENAME, UNLINK, TRUNCATE, MKDIR, LIST, STAT, LOCK, SPAWN, SEND, KINDS };
enum { HERE = -100, O_READ_WRITE = 0102, O_CREATE = 0100, O_TRUNCATE = 01000, O_FOR_APPENDING = 02001 }; /* fcntl.h declares variadic functions */

static struct {
    int is_on, kind, first, last, error, is_recorded, counts[KINDS];
    char root[1024], record[1024];
} *control;

__attribute__((constructor)) static void start(void) {
    const char *path = getenv("FAULT_CONTROL");
    int file = path ? (int)syscall(SYS_openat, HERE, path, 02, 0) : -1;
    if (file < 0) return;
    control = mmap(NULL, sizeof *control, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (control == MAP_FAILED) control = NULL;
    syscall(SYS_close, file);
}

/* Whether this call is one of those that fail. */
static int fails(int kind) {
    int count = __atomic_add_fetch(&control->counts[kind], 1, __ATOMIC_SEQ_CST);
    if (kind != control->kind || count < control->first || count > control->last) return 0;
    errno = control->error;
    return 1;
}

static const char *path_of(int file, char *buffer) {
    char link[64];
    snprintf(link, sizeof link, file == HERE ? "/proc/self/cwd" : "/proc/self/fd/%d", file);
    long size = syscall(SYS_readlinkat, HERE, link, buffer, 1023);
    buffer[size < 0 ? 0 : size] = 0;
    return buffer;
}

static int is_on(void) { return control && control->is_on; }

static int is_below(int folder, const char *path) {
    char buffer[1024];
    return is_on() && path && !strncmp(*path == '/' ? path : path_of(folder, buffer), control->root, strlen(control->root));
}

static int is_file(int file) { return is_below(file, ""); }

static int is_channel(int file) {
    char buffer[1024];
    return is_on() && file > 2 && (!strncmp(path_of(file, buffer), "pipe:", 5) || !strncmp(buffer, "socket:", 7));
}

/* Append a call to the record: numbers, path and, as bytes, the data or the second path. */
static void record(int kind, const char *path, long offset, const void *data, long size) {
    int saved = errno;
    long head[] = {kind, offset, (long)strlen(path), size};
    struct iovec parts[] = {{head, sizeof head}, {(void *)path, strlen(path)}, {(void *)data, size}};
    int file = (int)syscall(SYS_openat, HERE, control->record, O_FOR_APPENDING, 0);
    syscall(SYS_writev, file, parts, 3);
    syscall(SYS_close, file);
    errno = saved;
}

static void record_file(int kind, int file, long offset, const void *data, long size) {
    char buffer[1024];
    record(kind, path_of(file, buffer), offset, data, size);
}

static long end_of_write(int file) { return syscall(SYS_lseek, file, 0, 1); }

#define CALL(kind, type, name, parameters, arguments, concerns, failure, recorded)          \
    type name parameters {                                                                   \
        static type(*real) parameters;                                                       \
        if (!real) *(void **)&real = dlsym(RTLD_NEXT, #name);                                \
        int is_concerned = (concerns);                                                       \
        if (is_concerned && fails(kind)) return failure;                                     \
        type result = real arguments;                                                        \
        if (is_concerned && control->is_recorded && result != (type)(failure)) { recorded; } \
        return result;                                                                       \
    }
#define ON_PATH(kind, type, name, parameters, arguments, recorded) \
    CALL(kind, type, name, parameters, arguments, is_below(HERE, path), (type)-1, recorded)
#define ON_FILE(kind, type, name, parameters, arguments, recorded) \
    CALL(kind, type, name, parameters, arguments, is_file(file), (type)-1, recorded)
#define OPENED \
    if (flags & (O_CREATE | O_TRUNCATE)) record_file(OPEN, result, !!(flags & O_TRUNCATE), "", 0)

ON_PATH(OPEN, int, open, (const char *path, int flags, unsigned mode), (path, flags, mode), OPENED)
ON_PATH(OPEN, int, open64, (const char *path, int flags, unsigned mode), (path, flags, mode), OPENED)
CALL(OPEN, int, openat64, (int at, const char *path, int flags, unsigned mode), (at, path, flags, mode), is_below(at, path), -1, OPENED)
ON_FILE(READ, ssize_t, read, (int file, void *data, size_t size), (file, data, size), )
ON_FILE(READ, ssize_t, pread64, (int file, void *data, size_t size, off_t at), (file, data, size, at), )
ON_FILE(WRITE, ssize_t, pwrite64, (int file, const void *data, size_t size, off_t at), (file, data, size, at),
        record_file(WRITE, file, at, data, result))
ON_FILE(SYNC, int, fsync, (int file), (file), record_file(SYNC, file, 0, "", 0))
ON_FILE(SYNC, int, fdatasync, (int file), (file), record_file(SYNC, file, 0, "", 0))
ON_FILE(TRUNCATE, int, ftruncate64, (int file, off_t size), (file, size), record_file(TRUNCATE, file, size, "", 0))
ON_PATH(RENAME, int, rename, (const char *path, const char *to), (path, to), record(RENAME, path, 0, to, strlen(to)))
ON_PATH(UNLINK, int, unlink, (const char *path), (path), record(UNLINK, path, 0, "", 0))
CALL(UNLINK, int, unlinkat, (int at, const char *path, int flags), (at, path, flags), is_below(at, path), -1, )
ON_PATH(UNLINK, int, rmdir, (const char *path), (path), )
ON_PATH(MKDIR, int, mkdir, (const char *path, mode_t mode), (path, mode), record(MKDIR, path, 0, "", 0))
CALL(LIST, DIR *, opendir, (const char *path), (path), is_below(HERE, path), NULL, )
CALL(LIST, DIR *, fdopendir, (int file), (file), is_file(file), NULL, )
CALL(LIST, struct dirent64 *, readdir64, (DIR *folder), (folder), is_file(dirfd(folder)), NULL, )
ON_PATH(STAT, int, stat64, (const char *path, struct stat64 *found), (path, found), )
ON_PATH(STAT, int, lstat64, (const char *path, struct stat64 *found), (path, found), )
ON_PATH(STAT, int, access, (const char *path, int mode), (path, mode), )
ON_FILE(STAT, int, fstat64, (int file, struct stat64 *found), (file, found), )
CALL(STAT, int, fstatat64, (int at, const char *path, struct stat64 *found, int flags), (at, path, found, flags), is_below(at, path), -1, )
/* Commands 5 to 7 and 36 to 38 lock a file. */
CALL(LOCK, int, fcntl64, (int file, int command, void *argument), (file, command, argument),
     ((command >= 5 && command <= 7) || (command >= 36 && command <= 38)) && is_file(file), -1, )
CALL(SPAWN, pid_t, fork, (void), (), is_on(), -1, )
CALL(SEND, ssize_t, send, (int file, const void *data, size_t size, int flags), (file, data, size, flags), is_channel(file), -1, )
CALL(SEND, ssize_t, sendmsg, (int file, const struct msghdr *message, int flags), (file, message, flags), is_channel(file), -1, )

/* A vforked child must not return from here, so it is forked. */
pid_t vfork(void) { return fork(); }

/* No messages to workers: those to Python's resource tracker, the numbers of processes that its fork server
 * sends, and the signals that it sends to itself (one byte).
 * CPython waits forever if one is lost while the receiver lives. */
static int is_of_python(const char *data, size_t size) {
    return size == 1 || size == 8 || (size > 6 && (!memcmp(data, "PROBE:", 6) || memmem(data, size, "REGISTER:", 9)));
}

ssize_t write(int file, const void *data, size_t size) {
    int is_below_root = is_file(file);
    if (is_below_root ? fails(WRITE) : is_channel(file) && !is_of_python(data, size) && fails(SEND)) return -1;
    ssize_t written = syscall(SYS_write, file, data, size);
    if (is_below_root && control->is_recorded && written > 0)
        record_file(WRITE, file, end_of_write(file) - written, data, written);
    return written;
}

/* Record that a command has been acknowledged. */
void acknowledge(int number) { record(KINDS, "", number, "", 0); }
