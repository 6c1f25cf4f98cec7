#include "daemon/web/jobs.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::web {
namespace {

using testing::HasSubstr;

JobOrder shell(const std::string& script) {
  return {.kind = "verify", .recording = "wall.windlog", .command = {"/bin/sh", "-c", script, "sh"}};
}

Job job_of(const Jobs& jobs, const std::string& id) {
  const auto job = jobs.find(id);
  return job ? *job : Job{};
}
Job ended(const Jobs& jobs, const std::string& id) {
  while (job_of(jobs, id).state == Job::State::kRunning && jobs.find(id)) std::this_thread::yield();
  return job_of(jobs, id);
}

TEST(JobsTest, WhatItPrintsIsItsResult) {
  Jobs jobs;
  const Job job = ended(jobs, jobs.start(shell("printf '{}'; echo unused >&2")).value());
  EXPECT_EQ(job.state, Job::State::kDone);
  EXPECT_EQ(job.printed, "{}");
  EXPECT_EQ(job.recording, "wall.windlog");
  EXPECT_FALSE(jobs.find("no such id"));
}

TEST(JobsTest, ItRunsAtTheLowestPriority_OneThatSomebodyWaitsForBehindTheAnimation) {
  Jobs jobs;
  JobOrder order = shell("nice");
  EXPECT_EQ(ended(jobs, jobs.start(order).value()).printed, "19\n");
  order.niceness = Niceness::kAwaited;
  EXPECT_EQ(ended(jobs, jobs.start(order).value()).printed, "5\n");
}

/// Is it gone, or about to be?
bool has_ended(const std::string& process) {
  std::ifstream about("/proc/" + process + "/stat");
  std::string number, name, state;
  return !(about >> number >> name >> state) || state == "Z" || state == "X";
}

TEST(JobsTest, OneRunsAtATime_AndTheEndKillsItWithItsChildren) {
  const test::TemporaryFolder folder;
  const std::filesystem::path pid_file = folder.path() / "pid";
  Jobs jobs;
  const std::string id = jobs.start(shell("sleep 1000 & echo $! > '" + pid_file.string() + "2'; mv '" +
                                          pid_file.string() + "2' '" + pid_file.string() + "'; wait"))
                             .value();
  while (!std::filesystem::exists(pid_file)) std::this_thread::yield();
  const auto second = jobs.start(shell("true"));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, FailureKind::kUnavailable);
  EXPECT_THAT(second.error().message, HasSubstr("verify of wall.windlog"));
  jobs.end();
  EXPECT_EQ(job_of(jobs, id).state, Job::State::kFailed);
  EXPECT_THAT(job_of(jobs, id).message, HasSubstr("it was cancelled"));
  std::string process;
  std::ifstream(pid_file) >> process;
  while (!has_ended(process)) std::this_thread::yield();
}

TEST(JobsTest, ACancelledOneFails_AndTheNextRuns) {
  Jobs jobs;
  const std::string id = jobs.start(shell("sleep 1000")).value();
  EXPECT_TRUE(jobs.cancel(id));
  EXPECT_FALSE(jobs.cancel("no such id"));
  const Job job = ended(jobs, id);
  EXPECT_EQ(job.state, Job::State::kFailed);
  EXPECT_EQ(job.message, "it was cancelled");
  EXPECT_TRUE(jobs.cancel(id)) << "it has ended already";
  EXPECT_EQ(ended(jobs, jobs.start(shell("true")).value()).state, Job::State::kDone);
}

TEST(JobsTest, ItsFileHasNoNameAnyMore) {
  const test::TemporaryFolder folder;
  JobOrder order = shell("printf page > \"$1\"");
  order.result = "wall.html";
  order.folder = folder.path() / "job";
  std::filesystem::create_directories(order.folder / "left by a daemon that was killed");
  Jobs jobs;
  const Job job = ended(jobs, jobs.start(order).value());
  ASSERT_TRUE(job.file) << job.message;
  EXPECT_EQ(job.file->bytes, 4U);
  std::string text(4, ' ');
  EXPECT_EQ(pread(job.file->file->get(), text.data(), 4, 0), 4);
  EXPECT_EQ(text, "page");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(JobsTest, AFailureHasItsReason_AndAFindingIsNone) {
  Jobs jobs;
  EXPECT_EQ(ended(jobs, jobs.start(shell("echo 'the disk is full' >&2; exit 73")).value()).message, "the disk is full");
  EXPECT_THAT(ended(jobs, jobs.start(shell("kill -9 $$")).value()).message, HasSubstr("killed by signal 9"));
  JobOrder verify = shell("printf '{}'; exit 1");
  EXPECT_EQ(ended(jobs, jobs.start(verify).value()).state, Job::State::kFailed);
  verify.is_finding_good = true;
  EXPECT_EQ(ended(jobs, jobs.start(verify).value()).state, Job::State::kDone);
  verify.command = {"/no/such/program"};
  EXPECT_THAT(ended(jobs, jobs.start(verify).value()).message, HasSubstr("/no/such/program"));
}

TEST(JobsTest, WhatTakesTooLongOrPrintsTooMuchIsEnded) {
  Jobs jobs;
  JobOrder slow = shell("sleep 1000");
  slow.time = std::chrono::milliseconds(1);
  EXPECT_THAT(ended(jobs, jobs.start(slow).value()).message, HasSubstr("too long"));
  EXPECT_THAT(ended(jobs, jobs.start(shell("yes")).value()).message, HasSubstr("too much"));
}

TEST(JobsTest, OnlyTheLastOnesAreKept) {
  Jobs jobs;
  const std::string first = jobs.start(shell("true")).value();
  ended(jobs, first);
  for (std::size_t i = 0; i < Jobs::kMaxKept; ++i) ended(jobs, jobs.start(shell("true")).value());
  EXPECT_FALSE(jobs.find(first));
}

}  // namespace
}  // namespace yuragi::daemon::web
