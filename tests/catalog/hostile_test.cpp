// SPDX-License-Identifier: Apache-2.0
#include "catalog_fixture.hpp"

#include <chrono>
#include <string>

#include <gmock/gmock.h>

namespace kompono::catalog {
namespace {

using testing::HasSubstr;

std::string Repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// Whatever is asked, the file stays as it is and the answer comes soon.
class HostileTest : public CatalogTest {
 protected:
  HostileTest() : store_(Filled()), before_(State()) {}
  HostileTest(const HostileTest&) = delete;
  HostileTest& operator=(const HostileTest&) = delete;
  HostileTest(HostileTest&&) = delete;
  HostileTest& operator=(HostileTest&&) = delete;
  ~HostileTest() override {
    EXPECT_TRUE(State() == before_) << "the catalog was changed";
    EXPECT_FALSE(std::filesystem::exists("/tmp/kompono-hostile"));
  }

  [[nodiscard]] std::string State() const {
    std::string state;
    for (const std::string& name : FilesInFolder()) {
      state += name + "\n";
      if (!name.ends_with("-shm")) state += Bytes(File(name));  // locks live there
    }
    return state;
  }

  [[nodiscard]] std::string Ask(const QueryRequest& request) const {
    const auto begin = std::chrono::steady_clock::now();
    const Parsed<Table> table = store_.Query(request);
    const auto taken = std::chrono::steady_clock::now() - begin;
    EXPECT_LT(taken, request.limits.deadline + std::chrono::seconds(1)) << request.where;
    return table ? RenderText(*table) : Said(table.error());
  }

  Store store_;
  std::string before_;
};

struct Hostile {
  const char* what;
  std::string text;
  const char* code;
};

/// An expression for a text of so many x: a digit and zeros.
std::string Wide(int length) {
  int zeros = 0;
  for (; length >= 10; length /= 10) ++zeros;
  std::string text = "'" + std::string(static_cast<std::size_t>(length), 'x') + "'";
  for (; zeros > 0; --zeros) text = "replace(" + text + ", 'x', 'xxxxxxxxxx')";
  return text;
}

// Codes: E0520 syntax, E0522 unknown view, E0523 not allowed, E0524 quotes and brackets, E0525
// leaves the expression, E0527 too large, E0528 fails while running.
std::vector<Hostile> HostileTexts() {
  return {
      {"second statement", "1; DROP TABLE layout", "E0525"},
      {"closes our bracket", "1) OR (1", "E0524"},
      {"closes our bracket and goes on", "1); DROP TABLE layout; --", "E0525"},
      {"closes it within quotes of another kind", "name = '\"') OR (\"name\" = '\"'", "E0524"},
      {"union behind the bracket", "1) UNION SELECT 1,2,3,4,5,6,7,8 FROM (SELECT 1", "E0524"},
      {"comment to the end", "1 -- and the limit is gone", "E0525"},
      {"open comment", "1 /* and the rest is gone", "E0525"},
      {"closed comment", "1 /* hidden */ = 1", "E0525"},
      {"open quote", "name = 'x", "E0524"},
      {"open name", "name = \"x", "E0524"},
      {"open bracketed name", "name = [x", "E0524"},
      {"open back quote", "name = `x", "E0524"},
      {"escaped quote stays open", "name = 'x''", "E0524"},
      {"open bracket", "(id = 1", "E0524"},
      {"NUL", std::string("1\0; DROP TABLE layout", 21), "E0525"},
      {"control character", "1 \x01", "E0525"},
      {"broken UTF-8", "name = '\xff'", "E0525"},
      {"parameter", "id = ?1", "E0525"},
      {"named parameter", "id = :id", "E0525"},
      {"attach", "ATTACH '/tmp/kompono-hostile' AS x", "E0523"},
      {"attach in brackets", "(ATTACH '/tmp/kompono-hostile' AS x)", "E0520"},
      {"detach", "DETACH main", "E0523"},
      {"pragma", "PRAGMA writable_schema = 1", "E0523"},
      {"pragma as a function", "exists (select 1 from pragma_journal_mode('delete'))", "E0523"},
      {"table info", "exists (select 1 from pragma_table_info('layout'))", "E0523"},
      {"drop", "DROP TABLE layout", "E0523"},
      {"update", "(UPDATE layout SET name = 'x' RETURNING 1)", "E0520"},
      {"delete", "exists (DELETE FROM layout)", "E0520"},
      {"vacuum into", "VACUUM INTO '/tmp/kompono-hostile'", "E0523"},
      {"select", "select name from layouts", "E0523"},
      {"with", "with x as (select 1) select * from x", "E0523"},
      {"schema", "(select sql from sqlite_schema) is not null", "E0523"},
      {"schema by its old name", "(select sql from sqlite_master) is not null", "E0523"},
      {"table", "(select name from layout) = 'x'", "E0522"},
      {"texts", "(select toml from layout_text) is not null", "E0522"},
      {"table counted", "(select count(*) from layout) > 0", "E0522"},
      {"table counted by another alias", "(select count(*) from layout as layouts) > 0", "E0522"},
      {"view's name lent to a table",
       "'x' in (with metrics as (select toml as value from layout_text) select value from metrics)",
       "E0522"},
      {"statistics table", "exists (select 1 from dbstat)", "E0523"},
      {"statements table", "exists (select 1 from sqlite_stmt)", "E0523"},
      {"json table", "exists (select 1 from json_each('[1]'))", "E0523"},
      {"series table", "exists (select 1 from generate_series(1, 1000000000))", "E0522"},
      {"full text machinery", "fts3_tokenizer('simple') is null", "E0523"},
      {"recursion",
       "id in (with recursive c(x) as (select 1 union all select x + 1 from c) select x from c)",
       "E0523"},
      {"recursion without the word",
       "id in (with c(x) as (select 1 union all select x + 1 from c) select x from c)",
       "E0523"},
      {"extension", "load_extension('/tmp/x.so') is null", "E0523"},
      {"file written", "writefile('/tmp/kompono-hostile', 'x')", "E0523"},
      {"file read", "readfile('/etc/hostname') is null", "E0523"},
      {"editor", "edit('x', 'sh') is null", "E0523"},
      {"random bytes", "randomblob(1000000000) is null", "E0523"},
      {"zero bytes", "zeroblob(1000000000) is null", "E0523"},
      {"match", "name match 'x'", "E0523"},
      {"regexp", "name regexp '(a+)+$'", "E0523"},
      {"growing text",
       "length(replace(replace(replace(" + Wide(1000) +
           ", 'x', 'xxxxxxxxxx'), 'x', 'xxxxxxxxxx'), "
           "'x', 'xxxxx'))",
       "E0527"},
      {"growing by joining",
       "(select length(x||x||x||x) from (select y||y||y||y as x from (select z||z||z||z as y from "
       "(select " +
           Wide(9000) + " as z))))",
       "E0527"},
      {"long LIKE", "name like '" + Repeated("%a", 400) + "'", "E0528"},
      {"long GLOB", "name glob '" + Repeated("*a", 400) + "'", "E0528"},
      {"too long", "name = '" + std::string(20'000, 'x') + "'", "E0525"},
      {"deep brackets", Repeated("(", 3000) + "1" + Repeated(")", 3000), "E0520"},
      {"deep sum", "1" + Repeated("+1", 3000), "E0520"},
      {"deep not", Repeated("not ", 3000) + "1", "E0520"},
      {"deep selects", Repeated("(select ", 500) + "1" + Repeated(")", 500), "E0520"},
      {"many unions", "id in (select 1" + Repeated(" union all select 1", 100) + ")", "E0520"},
      {"many tables", "exists (select 1 from layouts" + Repeated(", layouts", 100) + ")", "E0520"},
      {"row of values", "id, name", "E0520"},
      {"two words", "id name", "E0520"},
      {"order smuggled in", "id order by name", "E0520"},
      {"limit smuggled in", "id limit 1", "E0520"},
  };
}

TEST_F(HostileTest, NoTextGetsOutOfTheExpression) {
  for (const Hostile& hostile : HostileTexts()) {
    EXPECT_THAT(Ask({.where = hostile.text}), HasSubstr(hostile.code)) << hostile.what;
  }
}

TEST_F(HostileTest, TheSameHoldsForColumnsAndSorting) {
  for (const Hostile& hostile : HostileTexts()) {
    const std::string what = hostile.what;
    if (what == "row of values" || what == "long LIKE" || what == "long GLOB")
      continue;  // are fine here, or not run
    EXPECT_THAT(Ask({.columns = hostile.text}), HasSubstr("error")) << what;
    EXPECT_THAT(Ask({.sort = hostile.text}), HasSubstr("error")) << what;
  }
  EXPECT_THAT(Ask({.columns = "name from layout"}), HasSubstr("E0520"));
  EXPECT_THAT(Ask({.columns = "* from layout_text"}), HasSubstr("E0520"));
  EXPECT_THAT(Ask({.columns = "toml"}), HasSubstr("E0521"));
  EXPECT_THAT(Ask({.sort = "name) limit 1 offset (0"}), HasSubstr("E0524"));
  EXPECT_THAT(Ask({.sort = "name limit 1"}), HasSubstr("E0520"));
}

TEST_F(HostileTest, PointsAtWhatIsNotAllowed) {
  EXPECT_EQ(Ask({.where = "id = 1 and load_extension('x') is null"}).substr(0, 161),
            "where:1:12: error: the function 'load_extension' is not allowed in a query [E0523]\n"
            " 1 | id = 1 and load_extension('x') is null\n"
            "   |            ^~~~~~~~~~~~~~\n"
            "  h");
  EXPECT_EQ(Ask({.where = "id in (select id from layout)"}),
            "where:1:23: error: no view is called 'layout' [E0522]\n"
            " 1 | id in (select id from layout)\n"
            "   |                       ^~~~~~\n"
            "  help: did you mean 'layouts'?\n"
            "1 error\n");
  EXPECT_EQ(Ask({.where = "1; DROP TABLE layout"}),
            "where:1:2: error: one expression is expected, not several statements [E0525]\n"
            " 1 | 1; DROP TABLE layout\n"
            "   |  ^\n"
            "1 error\n");
}

TEST_F(HostileTest, StopsWhenTheTimeIsUp) {
  const std::string endless = "(select count(*) from layouts" + Repeated(", parameters", 4) +
                              Repeated(", motions", 8) + ") < 0";
  QueryRequest request{.where = endless};
  request.limits.deadline = std::chrono::milliseconds(150);
  EXPECT_EQ(Ask(request),
            "query: error: stopped after 150 ms [E0526]\n"
            "  help: make the condition narrower, or allow more time\n1 error\n");
  EXPECT_THAT(Ask({.where = "id = 1", .columns = "name"}), HasSubstr("Lambda"))
      << "the next query is not stopped";
}

TEST_F(HostileTest, StopsWhenTheMemoryIsUp) {
  // 3^6 different texts of 20 kB are to be kept apart.
  std::string tables = "layouts a, layouts b, layouts c, layouts d, layouts e, layouts f";
  QueryRequest request{.where = "(select count(*) from (select distinct " + Wide(20'000) +
                                " || (a.id + 3*b.id + 9*c.id + 27*d.id + 81*e.id + "
                                "243*f.id) from " +
                                tables + ")) > 0"};
  request.limits.deadline = std::chrono::seconds(60);  // not what is tested here
  EXPECT_THAT(Ask(request), HasSubstr("Lambda")) << "15 MB are allowed";
  request.limits.memory_bytes = 4U << 20U;
  EXPECT_THAT(Ask(request), HasSubstr("needs more than 4 MB of memory [E0527]"));
}

TEST_F(HostileTest, StopsWhenTheAnswerIsTooLarge) {
  QueryRequest request{.columns = Repeated(Wide(90'000) + " || id, ", 20) + "id"};
  request.limits.result_bytes = 4U << 20U;
  EXPECT_THAT(Ask(request), HasSubstr("the answer is larger than 4 MB [E0527]"));
}

/// One call would count to two milliards, and nothing stops SQLite within a call.
TEST_F(HostileTest, FormatsAreNotAllowed) {
  const auto begin = std::chrono::steady_clock::now();
  for (const std::string name : {"printf", "format"}) {
    EXPECT_THAT(Ask({.where = "id = 1", .columns = "length(" + name + "('%.2000000000c', 'x'))"}),
                HasSubstr("the function '" + name + "' is not allowed in a query [E0523]"));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

TEST_F(HostileTest, PatternsWithManyStarsAreQuick) {
  EXPECT_THAT(
      Ask({.where = "replace(" + Wide(90'000) + ", 'x', ' ') like '" + Repeated("% ", 200) + "b'"}),
      testing::Not(HasSubstr("error")));
}

TEST_F(HostileTest, HarmlessTextsThatLookHostileAreAnswered) {
  for (const std::string text :
       {"name <> '; DROP TABLE layout; --'",
        "name <> 'it''s (open'",
        "\"name\" <> ')'",
        "[name] <> '/*'",
        "`name` <> '?'",
        "name <> 'select'",
        "replace(name, 'a', 'b') <> ''",
        "- -1 = 1",
        "id in (with m as (select layout_id from metrics) select layout_id from m)",
        "exists (select 1 from layouts a join metrics m on m.layout_id = a.id)",
        "(select count(*) from metrics) > 0",
        "(((((1)))))"}) {
    EXPECT_THAT(Ask({.where = text, .columns = "name"}), HasSubstr("Lambda")) << text;
  }
}

/// Operators of the full-text language and of SQL are words or nothing to a search.
TEST_F(HostileTest, SearchTextsAreWordsOnly) {
  const auto search = [this](const std::string& text) {
    const auto begin = std::chrono::steady_clock::now();
    const auto hits = store_.Search(text);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1)) << text;
    return hits ? std::to_string(hits->size()) : Said(hits.error());
  };
  EXPECT_EQ(search("jet"), "1");
  EXPECT_EQ(search("jet\" OR \"mill"), "0") << "would find two as an operator";
  EXPECT_EQ(search("jet NOT water"), "0") << "would find none either; the word 'not' is wanted";
  EXPECT_EQ(search("parts:jet"), "0") << "a column filter would find it";
  EXPECT_EQ(search("jet*"), "1");
  EXPECT_EQ(search("NEAR(jet water)"), "0");
  EXPECT_EQ(search("^lambda"), "1") << "the mark is no word";
  EXPECT_EQ(search("{name formula}: jet"), "0");
  EXPECT_EQ(search("'; DROP TABLE layout; --"), "0");
  EXPECT_EQ(search("')) UNION SELECT sql FROM sqlite_schema --"), "0");
  EXPECT_THAT(search(Repeated("a* ", 32)), testing::Not(HasSubstr("error")));
  for (const Hostile& hostile : HostileTexts()) {
    const std::string answer = search(hostile.text);
    EXPECT_TRUE(answer == "0" || answer.find("E0548") != std::string::npos || answer.size() == 1U)
        << hostile.what << ": " << answer;
  }
}

TEST_F(HostileTest, KeysOfSimilarLayoutsAreKeysOnly) {
  for (const Hostile& hostile : HostileTexts())
    EXPECT_EQ(CodeOf(store_.Similar(hostile.text)), "E0512") << hostile.what;
}

TEST_F(HostileTest, TheConnectionItselfCannotWrite) {
  // Even if a text got through: the second fence, tried directly.
  SQLite::Database db(File().string(), SQLite::OPEN_READONLY);
  EXPECT_THROW(db.exec("DELETE FROM layout"), SQLite::Exception);
}

class HostileCatalogTest : public CatalogTest {};

TEST_F(HostileCatalogTest, AReplacedViewCannotDoMoreThanRead) {
  static_cast<void>(Filled());
  // A file from elsewhere whose view would run for ever.
  Tamper(
      "DROP VIEW plugins; CREATE VIEW plugins AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT "
      "x + 1 FROM c) "
      "SELECT x AS layout_id, x AS layout, x AS plugin, x AS version FROM c");
  Parsed<Store> store = Store::Open(File());
  ASSERT_TRUE(store) << Said(store.error());
  EXPECT_EQ(CodeOf(store->Query({.where = "id in (select layout_id from plugins)"})), "E0508");
  EXPECT_FALSE(store->Verify()->Ok());
}

}  // namespace
}  // namespace kompono::catalog
