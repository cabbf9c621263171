// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/confinement.h"

#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <memory>

namespace talisman::sequences {

namespace {

constexpr rlim_t kMostOpenFiles = 256;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

void limit(__rlimit_resource resource, rlim_t most) {
  const rlimit limits{most, most};
  setrlimit(resource, &limits);
}

void set_limits(int seconds, long megabytes) {
  limit(RLIMIT_CPU, static_cast<rlim_t>(seconds));
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);  // pipes are no files
  limit(RLIMIT_NOFILE, kMostOpenFiles);
  if (!kIsSanitized) limit(RLIMIT_AS, static_cast<rlim_t>(megabytes) << 20);
}

/// A name that this kernel's processor does not have is no failure: it cannot be called.
class Filter {
 public:
  Filter() : context_(seccomp_init(SCMP_ACT_ALLOW), &seccomp_release) {
    if (!context_) error_ = ENOMEM;
  }

  void refuse(const char* call) { add(call, EPERM, 0, {}); }
  /// Who gets ENOSYS falls back on the older call, which can be looked into.
  void hide(const char* call) { add(call, ENOSYS, 0, {}); }
  void refuse_if(const char* call, const scmp_arg_cmp& argument) { add(call, EPERM, 1, argument); }
  /// 0 or the error.
  int load() {
    if (error_ == 0) error_ = -seccomp_load(context_.get());
    return error_;
  }

 private:
  void add(const char* call, int answer, unsigned arguments, const scmp_arg_cmp& argument) {
    const int number = seccomp_syscall_resolve_name(call);
    if (number == __NR_SCMP_ERROR || error_ != 0) return;
    const int added =
        seccomp_rule_add_array(context_.get(), SCMP_ACT_ERRNO(static_cast<std::uint16_t>(answer)), number,
                               arguments, arguments > 0 ? &argument : nullptr);
    if (added != 0 && added != -EDOM) error_ = -added;
  }

  std::unique_ptr<void, decltype(&seccomp_release)> context_;
  int error_ = 0;
};

void refuse_network_and_processes(Filter& filter) {
  for (const char* call : {"socket", "socketpair", "connect", "bind", "listen", "accept", "accept4"})
    filter.refuse(call);
  for (const char* call : {"fork", "vfork", "execve", "execveat", "kill", "ptrace", "process_vm_readv",
                           "process_vm_writev", "pidfd_open", "pidfd_getfd", "setns", "unshare"})
    filter.refuse(call);
  filter.refuse_if("clone", SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0));  // threads are its own affair
  filter.hide("clone3");
}

void refuse_new_files(Filter& filter) {
  for (const char* call :
       {"creat",     "mkdir",  "mkdirat",   "mknod",     "mknodat",   "link",      "linkat",     "symlink",
        "symlinkat", "rename", "renameat",  "renameat2", "unlink",    "unlinkat",  "rmdir",      "truncate",
        "ftruncate", "chmod",  "fchmod",    "fchmodat",  "chown",     "fchown",    "lchown",     "fchownat",
        "utime",     "utimes", "utimensat", "setxattr",  "lsetxattr", "fsetxattr", "removexattr"})
    filter.refuse(call);
  for (const auto& [call, flags] : {std::pair{"open", 1u}, {"openat", 2u}}) {
    filter.refuse_if(call, SCMP_CMP(flags, SCMP_CMP_MASKED_EQ, O_ACCMODE, O_WRONLY));
    filter.refuse_if(call, SCMP_CMP(flags, SCMP_CMP_MASKED_EQ, O_ACCMODE, O_RDWR));
    filter.refuse_if(call, SCMP_CMP(flags, SCMP_CMP_MASKED_EQ, O_CREAT, O_CREAT));
  }
  filter.hide("openat2");
}

/// Of the machine, for who is root; and what does the above by another door.
void refuse_the_rest(Filter& filter) {
  for (const char* call :
       {"mount",       "umount2",      "pivot_root",       "chroot",          "bpf",
        "init_module", "finit_module", "delete_module",    "kexec_load",      "kexec_file_load",
        "reboot",      "swapon",       "swapoff",          "perf_event_open", "io_uring_setup",
        "keyctl",      "add_key",      "request_key",      "setuid",          "setgid",
        "setreuid",    "setresuid",    "open_by_handle_at"})
    filter.refuse(call);
}

}  // namespace

std::string confine(int seconds, long megabytes) {
  std::signal(SIGINT, SIG_IGN);   // Ctrl-C is for the tool; it ends its reader when it ends itself
  std::signal(SIGXFSZ, SIG_IGN);  // what it writes to a file fails, and is no crash
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  set_limits(seconds, megabytes);
  if (kIsSanitized) return "the build has sanitizers";
  Filter filter;
  refuse_network_and_processes(filter);
  refuse_new_files(filter);
  refuse_the_rest(filter);
  const int error = filter.load();
  return error == 0 ? "" : std::string("the kernel takes no filter: ") + std::strerror(error);
}

std::string confinement_in_words(const std::string& why_no_filter) {
  const std::string always = "limits of time, memory and files";
  return why_no_filter.empty() ? always + "; no network, no new files, no new processes"
                               : always + " alone (" + why_no_filter + ")";
}

}  // namespace talisman::sequences
