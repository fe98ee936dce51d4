/* Makes the n-th call that changes a file fail, and lists such calls: preloaded
 * into the program by the tests of faults 76 to 78 and 100.
 *
 * FAULT_AT: which call fails, counted from 1. FAULT_ERRNO: how. FAULT_LOG: the
 * list, a line a call. Only paths below FAULT_BELOW, and files opened there,
 * count, so that the cache and the terminal are left alone. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int calls;
static char watched[4096];

static int below(const char *path) {
    const char *folder = getenv("FAULT_BELOW");
    return folder && strncmp(path, folder, strlen(folder)) == 0;
}

static int fails(const char *call) {
    const char *at = getenv("FAULT_AT");
    const char *how = getenv("FAULT_ERRNO");
    const char *list = getenv("FAULT_LOG");
    int number = __sync_add_and_fetch(&calls, 1);
    if (list) {
        FILE *log = fopen(list, "a");
        if (log) {
            fprintf(log, "%s\n", call);
            fclose(log);
        }
    }
    if (at && number == atoi(at)) {
        errno = how ? atoi(how) : EIO;
        return 1;
    }
    return 0;
}

static int opened(const char *path, int flags, int mode, const char *name) {
    int (*real)(const char *, int, ...) = dlsym(RTLD_NEXT, name);
    int changes = (flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0;
    int fd;
    if (below(path) && changes && fails("open"))
        return -1;
    fd = real(path, flags, mode);
    if (fd >= 0 && fd < (int)sizeof watched)
        watched[fd] = below(path);
    return fd;
}

int open(const char *path, int flags, ...) {
    va_list list;
    va_start(list, flags);
    int mode = va_arg(list, int);
    va_end(list);
    return opened(path, flags, mode, "open");
}

int open64(const char *path, int flags, ...) {
    va_list list;
    va_start(list, flags);
    int mode = va_arg(list, int);
    va_end(list);
    return opened(path, flags, mode, "open64");
}

int close(int fd) {
    int (*real)(int) = dlsym(RTLD_NEXT, "close");
    if (fd >= 0 && fd < (int)sizeof watched)
        watched[fd] = 0;
    return real(fd);
}

ssize_t write(int fd, const void *bytes, size_t count) {
    ssize_t (*real)(int, const void *, size_t) = dlsym(RTLD_NEXT, "write");
    if (fd >= 0 && fd < (int)sizeof watched && watched[fd] && fails("write"))
        return -1;
    return real(fd, bytes, count);
}

int fsync(int fd) {
    int (*real)(int) = dlsym(RTLD_NEXT, "fsync");
    if (fd >= 0 && fd < (int)sizeof watched && watched[fd] && fails("fsync"))
        return -1;
    return real(fd);
}

int rename(const char *from, const char *to) {
    int (*real)(const char *, const char *) = dlsym(RTLD_NEXT, "rename");
    if (below(to) && fails("rename"))
        return -1;
    return real(from, to);
}

int mkdir(const char *path, mode_t mode) {
    int (*real)(const char *, mode_t) = dlsym(RTLD_NEXT, "mkdir");
    if (below(path) && fails("mkdir"))
        return -1;
    return real(path, mode);
}
