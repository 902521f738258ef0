// See sim/pair_contact_pass.h. The buffers' layout stands in shaders/pair_buffers.glsl and thread_hold.comp.
#include "sim/pair_contact_pass.h"

#include "gpu/program.h"
#include "shaders/shared_constants.h"
#include "sim/pair_contact_skin.h"
#include "sim/state_textures.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace serosa::sim {

namespace {

constexpr int kSolveItems = 4096; // invocations that share a round's touches

struct OrganRecord {
    glm::vec4 place;
    glm::uvec4 range, boxes, touches;
};
struct NodeRecord {
    glm::vec4 rest, kind;
    glm::ivec4 beside, more;
};
struct ThreadRecord {
    std::array<std::uint32_t, 16> nodes;
    std::array<float, 16> weights;
    float length, tightening, strength, pull;
    std::int32_t clip, unused[3];
};
struct ThreadNow {
    float startLength, force, most, broken, brokenAfter, impulse, work, given;
};
constexpr std::size_t kMotionBytes = 64, kSkinBytes = 32, kBoxBytes = 32, kTouchBytes = 80;

void wait() {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

class TextureCoupling final : public Coupling {
public:
    TextureCoupling(const std::vector<GroupMember>& members, const GroupSettings& settings)
        : members_(members), settings_(settings), timeStep_(members.front().solver->setup().timeStep),
          pending_(members.size(), std::vector<PairLoad>(members.size())) {}

    Status initialize() {
        const gpu::ShaderLibrary library;
        SEROSA_ASSIGN(read_, gpu::Program::create(library, {"pair_read.comp"}));
        SEROSA_ASSIGN(skin_, gpu::Program::create(library, {"pair_skin.comp"}));
        SEROSA_ASSIGN(leaves_, gpu::Program::create(library, {"pair_boxes.comp"}, {{"SRS_LEAVES", "1"}}));
        SEROSA_ASSIGN(tops_, gpu::Program::create(library, {"pair_boxes.comp"}));
        SEROSA_ASSIGN(find_, gpu::Program::create(library, {"pair_find.comp"}));
        SEROSA_ASSIGN(solve_, gpu::Program::create(library, {"pair_solve.comp"}));
        SEROSA_ASSIGN(apply_, gpu::Program::create(library, {"pair_apply.comp"}));
        SEROSA_ASSIGN(write_, gpu::Program::create(library, {"pair_write.comp"}));
        if (!settings_.threads.empty()) {
            SEROSA_ASSIGN(hold_, gpu::Program::create(library, {"thread_hold.comp"}));
        }
        SEROSA_CHECK(settings_.threads.size() <= SRS_MAX_THREADS, "at most SRS_MAX_THREADS threads");
        rebuild();
        setThreads(std::vector<ThreadState>(settings_.threads.size()));
        return {};
    }

    void couple(std::int64_t step) override {
        glMemoryBarrier(GL_ALL_BARRIER_BITS); // the solvers draw or store
        for (std::size_t i = 0; i < members_.size(); ++i) {
            const StateTextures& textures = *members_[i].solver->textures();
            read_.set("u_organ", unsigned(i));
            read_.image("i_positions", textures.positions(), GL_READ_ONLY);
            read_.image("i_increments", textures.increments(), GL_READ_ONLY);
            read_.image("i_nodeInfo", textures.nodeInfo(), GL_READ_ONLY);
            read_.dispatch({int(group_.organs[i].nodes), 1, 1});
        }
        wait();
        if (!settings_.threads.empty())
            holdThreads(step);
        if (touches_ > 0)
            solveContacts();
        for (std::size_t i = 0; i < members_.size(); ++i) {
            const StateTextures& textures = *members_[i].solver->textures();
            write_.set("u_organ", unsigned(i));
            write_.image("i_positions", textures.positions(), GL_READ_WRITE);
            write_.image("i_increments", textures.increments(), GL_READ_WRITE);
            write_.dispatch({int(group_.organs[i].nodes), 1, 1});
        }
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
    }

    void reconnect(std::size_t) override {
        pending_ = takeLoads();
        rebuild();
    }

    PairLoads takeLoads() override {
        const std::size_t organs = members_.size();
        const double unit = group_.mass * group_.length / (timeStep_ * SRS_PAIR_FIXED); // to N s
        PairLoads taken(organs, std::vector<PairLoad>(organs));
        std::swap(taken, pending_);
        std::vector<std::uint32_t> words(8 * organs * organs);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        sums_.download(SRS_PAIR_LOADS * sizeof words[0], words.size() * sizeof words[0], words.data());
        for (std::size_t i = 0; i < organs * organs; ++i) {
            const auto sum = [&](std::size_t k) {
                return unit * double(std::int64_t(words[8 * i + 2 * k] |
                                                  std::uint64_t(words[8 * i + 2 * k + 1]) << 32));
            };
            PairLoad& load = taken[i / organs][i % organs];
            load.impulse += glm::dvec3(sum(0), sum(1), sum(2));
            load.pressed += sum(3);
        }
        std::fill(words.begin(), words.end(), 0u);
        sums_.upload(SRS_PAIR_LOADS * sizeof words[0], words.size() * sizeof words[0], words.data());
        return taken;
    }

    std::vector<ThreadState> threads() const override {
        std::vector<ThreadState> states;
        if (settings_.threads.empty())
            return states;
        std::vector<ThreadNow> now(settings_.threads.size());
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        threadStates_.download(0, now.size() * sizeof now[0], now.data());
        for (const ThreadNow& t : now)
            states.push_back({t.startLength < 0 ? -1 : double(t.startLength) * group_.length,
                              t.force * newton(), t.most * newton(), t.broken != 0, t.brokenAfter,
                              t.impulse * newton() * timeStep_, t.work * newton() * group_.length});
        return states;
    }

    void setThreads(const std::vector<ThreadState>& states) override {
        SEROSA_CHECK(states.size() == settings_.threads.size(), "one state a thread");
        std::vector<ThreadNow> now;
        for (const ThreadState& s : states)
            now.push_back({s.startLength < 0 ? -1 : float(s.startLength / group_.length),
                           float(s.force / newton()), float(s.mostForce / newton()), s.broken ? 1.0F : 0.0F,
                           float(s.brokenAfter), float(s.impulse / (newton() * timeStep_)),
                           float(s.work / (newton() * group_.length)), 0});
        if (!now.empty())
            threadStates_.upload(0, now.size() * sizeof now[0], now.data());
    }

private:
    /// N that a group unit of impulse a step is.
    double newton() const { return group_.mass * group_.length / (timeStep_ * timeStep_); }

    void rebuild() {
        group_ = coupleOrgans(coupledMembers(members_, settings_));
        std::vector<OrganRecord> organs;
        std::uint32_t leaf = std::uint32_t(group_.triangles.size());
        const auto blocks = [](std::uint32_t count) {
            return (count + SRS_PAIR_BRANCH - 1) / SRS_PAIR_BRANCH;
        };
        std::uint32_t allLeaves = 0, allTops = 0;
        for (const CoupledOrgan& o : group_.organs) {
            const std::uint32_t count = blocks(o.triangles);
            organs.push_back({glm::vec4(o.shift, o.scale),
                              {o.firstNode, o.skinNodes, o.firstTriangle, o.triangles},
                              {leaf + allLeaves, count, 0, blocks(count)},
                              {o.touches, o.touchesItself, o.nodes, 0}});
            allLeaves += count;
        }
        const std::uint32_t top = leaf + allLeaves;
        for (OrganRecord& o : organs) {
            o.boxes.z = top + allTops;
            allTops += o.boxes.w;
        }
        std::vector<NodeRecord> nodes;
        touches_ = 0;
        for (std::size_t i = 0; i < group_.nodeCount(); ++i) {
            const std::size_t o = group_.organOf[i];
            const CoupledOrgan& organ = group_.organs[o];
            const glm::uvec2 texel =
                members_[o].solver->textures()->layout().texelOfNode[group_.latticeNode[i]];
            const auto& beside = group_.beside[i];
            nodes.push_back({glm::vec4(group_.restNormal[i], group_.depth[i]),
                             glm::vec4(group_.thickness[i], group_.flatness[i], group_.inverseMass[i], 0),
                             {beside[0], beside[1], beside[2], beside[3]},
                             {beside[4], beside[5], int(o), int(texel.x | texel.y << 16)}});
            if (i >= organ.firstNode + organ.skinNodes)
                continue;
            for (std::size_t other = 0; other < group_.organs.size(); ++other)
                touches_ += o == other ? organ.touchesItself : organ.touches && group_.organs[other].touches;
        }
        std::vector<std::uint32_t> lists;
        for (const glm::uvec3& t : group_.triangles)
            lists.insert(lists.end(), {t.x, t.y, t.z});
        const auto near = std::uint32_t(lists.size()), first = near + std::uint32_t(group_.nodeCount()) + 1;
        for (const std::uint32_t offset : group_.nearFirst)
            lists.push_back(first + offset);
        lists.insert(lists.end(), group_.near.begin(), group_.near.end());

        const std::size_t members = members_.size();
        const auto given = std::uint32_t(SRS_PAIR_LOADS + 8 * members * members);
        const std::vector<std::uint32_t> zeros(given + 4 * nodes.size(), 0u);
        organs_ = gpu::Buffer("coupled organs", std::span<const OrganRecord>(organs));
        nodes_ = gpu::Buffer("coupled nodes", std::span<const NodeRecord>(nodes));
        lists_ = gpu::Buffer("coupled triangles", std::span<const std::uint32_t>(lists));
        sums_ = gpu::Buffer("coupling sums", std::span<const std::uint32_t>(zeros));
        motions_ = gpu::Buffer("coupled motion", nodes.size() * kMotionBytes, nullptr);
        skins_ = gpu::Buffer("skins", nodes.size() * kSkinBytes, nullptr);
        boxes_ = gpu::Buffer("skin boxes", (top + allTops) * kBoxBytes, nullptr);
        contacts_ = gpu::Buffer("touches", touches_ * kTouchBytes, nullptr);
        leafCount_ = int(allLeaves);
        topCount_ = int(allTops);
        for (gpu::Program* program : {&read_, &skin_, &leaves_, &tops_, &find_, &solve_, &apply_, &write_})
            bind(*program);
        skin_.set("u_nodes", unsigned(nodes.size()));
        for (gpu::Program* boxes : {&leaves_, &tops_}) {
            boxes->set("u_organs", unsigned(members));
            boxes->set("u_boxes", unsigned(boxes == &leaves_ ? allLeaves : allTops));
            boxes->set("u_leaf", leaf);
            boxes->set("u_top", top);
        }
        find_.set("u_nodes", unsigned(nodes.size())).set("u_organs", unsigned(members)).set("u_near", near);
        solve_.set("u_friction", float(settings_.friction)).set("u_organs", unsigned(members));
        apply_.set("u_nodes", unsigned(nodes.size()));
        for (gpu::Program* program : {&read_, &find_, &solve_, &apply_})
            program->set("u_given", given);
        rebuildThreads();
    }

    void bind(gpu::Program& program) const {
        program.buffer("b_organs", organs_).buffer("b_nodes", nodes_).buffer("b_motions", motions_);
        program.buffer("b_skins", skins_).buffer("b_boxes", boxes_).buffer("b_lists", lists_);
        program.buffer("b_touches", contacts_).buffer("b_sums", sums_);
    }

    void rebuildThreads() {
        if (settings_.threads.empty())
            return;
        std::vector<ThreadRecord> records;
        for (const ThreadSpan& span : threadSpans(group_, settings_.threads)) {
            ThreadRecord record{};
            record.nodes = span.nodes;
            std::copy(span.weights.begin(), span.weights.end(), record.weights.begin());
            record.length = float(span.thread.length / group_.length);
            record.tightening = float(span.thread.tightening);
            record.strength = float(span.thread.strength / newton());
            record.pull = float(span.pull / group_.length);
            record.clip = span.thread.clip;
            records.push_back(record);
        }
        threads_ = gpu::Buffer("threads", std::span<const ThreadRecord>(records));
        if (!threadStates_)
            threadStates_ = gpu::Buffer("thread states", records.size() * sizeof(ThreadNow), nullptr);
        bind(hold_);
        hold_.buffer("b_threads", threads_).buffer("b_threadStates", threadStates_);
        hold_.set("u_threads", int(records.size()));
        hold_.set("u_timeStep", float(timeStep_)).set("u_meanShare", float(threadMeanShare(timeStep_)));
    }

    void holdThreads(std::int64_t step) {
        std::array<float, SRS_MAX_THREADS> elapsed{};
        for (std::size_t i = 0; i < settings_.threads.size(); ++i) {
            const Thread& thread = settings_.threads[i].thread;
            elapsed[i] = threadTied(thread, step, timeStep_)
                             ? float(std::max(0.0, double(step) * timeStep_ - thread.time))
                             : -1.0F;
        }
        hold_.set("u_elapsed", std::span<const float>(elapsed));
        hold_.dispatch({1, 1, 1});
        wait();
    }

    void solveContacts() {
        const int nodes = int(group_.nodeCount());
        skin_.dispatch({nodes, 1, 1});
        wait();
        leaves_.dispatch({leafCount_, 1, 1});
        wait();
        tops_.dispatch({topCount_, 1, 1});
        wait();
        find_.dispatch({nodes, 1, 1});
        wait();
        for (int round = 0; round < SRS_PAIR_ROUNDS; ++round) {
            const bool last = round + 1 == SRS_PAIR_ROUNDS;
            solve_.set("u_ahead", ahead(round)).set("u_last", last ? 1 : 0);
            solve_.dispatch({int(std::min<std::size_t>(touches_, kSolveItems)), 1, 1});
            wait();
            apply_.set("u_ahead", last ? 0.0F : ahead(round + 1));
            apply_.dispatch({nodes, 1, 1});
            wait();
        }
    }
    static float ahead(int round) { return float(round / (round + 3.0)); }

    std::vector<GroupMember> members_;
    GroupSettings settings_;
    double timeStep_;
    CoupledGroup group_;
    std::size_t touches_ = 0; // that may be
    int leafCount_ = 0, topCount_ = 0;
    gpu::Program read_, skin_, leaves_, tops_, find_, solve_, apply_, write_, hold_;
    gpu::Buffer organs_, nodes_, lists_, sums_, motions_, skins_, boxes_, contacts_, threads_, threadStates_;
    PairLoads pending_; // from before the buffers were made anew
};

} // namespace

Result<std::unique_ptr<Coupling>> makeTextureCoupling(const std::vector<GroupMember>& members,
                                                      const GroupSettings& settings) {
    auto coupling = std::make_unique<TextureCoupling>(members, settings);
    SEROSA_TRY(coupling->initialize());
    return std::unique_ptr<Coupling>(std::move(coupling));
}

} // namespace serosa::sim
