# 任務のことば。英語の原文は assets/missions/*.toml にあります。

mission-01-training-title = 訓練
mission-01-training-idea = 見えているのは過去の姿です。そして軌道とは、落ち続けることです。
mission-01-training-brief =
    短い練習が七つあります。どれも時間はたっぷりあります。追ってくるものはいません。「やさしい」では、ドローンも眠っています。
    あなたの船は、ブラックホールのまわりを落ち続けています。それが軌道です。エンジンは、その落ち方を変えるだけです。
mission-01-training-goal-1 = 噴射する
mission-01-training-goal-1-hint = [thrust_forward] を押し続けると、エンジンが船を前へ押します。[thrust_back] は後ろへ、[thrust_left] と [thrust_right] は横へ押します。[boost] で全力噴射です。
mission-01-training-goal-2 = 船の向きを変える
mission-01-training-goal-2-hint = マウスか、[yaw_left]・[yaw_right] を使います。[pitch_up] で船首が上へ、[pitch_down] で下へ向きます。変わるのは船首の向きだけです。飛んでいく方向は変わりません。
mission-01-training-goal-3 = 落ちる：キーから手をはなす
mission-01-training-goal-3-hint = マウスも、すべてから手をはなしてください。アシストはまだ少し噴射して、落下を円軌道に変えます。
mission-01-training-goal-4 = ドローンを見る
mission-01-training-goal-4-hint = [look_at_target] を押し続けるか、船首を青い印へ向けます。その光は、少し前にドローンを出たものです。どれだけ前かは、印に書いてあります。
mission-01-training-goal-5 = ドローンのそばまで飛んで、止まる
mission-01-training-goal-5-hint = [face_target] を押し続けると、船首が「噴射」の印へ向きます。「落ちるだけで会えます」と出るまで [thrust_forward] も押し続けます。「今すぐ減速」と出たときと、4 r_s 以内に入ったら、[toggle_assist] を押し続けます。ドローンに対する動きが消えます。
mission-01-training-goal-6 = ドローンと同じ動きをする
mission-01-training-goal-6-hint = ドローンに対する動きの矢印が消えるまで、[toggle_assist] を押し続けます。4 r_s より遠いときは、「現在」の輪のほうへ少し押しましょう。
mission-01-training-goal-7 = ドローンをつかまえる：1.5 r_s 以内にとどまる
mission-01-training-goal-7-hint = [face_target] を押し、「落ちるだけで会えます」と出るまで [thrust_forward] も押し続けます。そのまま待ちます。「今すぐ減速」と出たときと、1.5 r_s 以内に入ったら、[toggle_assist] を押し続けます。[slower] で、すべてがゆっくりになります。

mission-02-first-pursuit-title = 最初の追跡
mission-02-first-pursuit-idea = 低い軌道ほど速く回ります。追いつきたければ、下りましょう。
mission-02-first-pursuit-brief =
    燃料が残り少ない貨物船が、遠くの軌道をあなたから逃げています。画面の中央の輪が閉じるまで、そのそばにいてください。
    ねらうのは、見えている姿ではなく「現在」の輪です。見えているのは、前にいた場所です。
mission-02-first-pursuit-goal-1 = 貨物船をつかまえる：そばにとどまる
mission-02-first-pursuit-goal-1-hint = [face_target] を押し、「落ちるだけで会えます」と出るまで [thrust_forward] も押し続けます。「今すぐ減速」と出たときと、そばでは、[toggle_assist] を押し続けます。小さな輪は、最も近づく場所です。

mission-03-through-the-disk-title = 円盤をぬけて
mission-03-through-the-disk-idea = 光はブラックホールの上を曲がって届きます。だから、円盤の向こう側が上に見えます。
mission-03-through-the-disk-brief =
    標的は円盤の中を飛び、光るガスにかくれています。円盤の向こう側はブラックホールの上に持ち上がって見え、裏側は下に見えます。
    ガスは通りぬけられます。ブラックホールは通りぬけられません。
mission-03-through-the-disk-goal-1 = ガスの中の標的をつかまえる
mission-03-through-the-disk-goal-1-hint = 標的は、円盤の面の中を飛んでいます。まず円盤の面まで行き、それから「現在」の輪を追いましょう。

mission-04-the-ghost-title = 幽霊船
mission-04-the-ghost-idea = 一せきの船に、像が二つ。どちらも過去の姿で、古さがちがいます。
mission-04-the-ghost-brief =
    幽霊船の居場所は、だれも教えてくれません。見えるのは、その光だけです。第1の像と、ブラックホールを回りこんできた、もっと古い第2の像です。
    船は、そのあとも飛び続けています。点線は、像の場所からどう落ちていくかを示します。相手もまた、光でしかあなたを知りません。
mission-04-the-ghost-goal-1 = 幽霊船の光を見つける
mission-04-the-ghost-goal-1-hint = [look_at_target] を押し続けると、カメラが第1の像のほうを向きます。印のそばの数字は、その像がどれだけ古いかを表します。
mission-04-the-ghost-goal-2 = 幽霊船をつかまえる
mission-04-the-ghost-goal-2-hint = 「自由に落ちたらここ」の十字を目ざしましょう。噴射していなければ、船はそこにいます。減速は「現在」の輪のときと同じです。

mission-05-the-last-orbit-title = 最後の軌道
mission-05-the-last-orbit-idea = r = 3 より下の円軌道は不安定です。少しずれただけで、落ちこむか、外へ飛び出します。
mission-05-the-last-orbit-brief =
    安定な円軌道がなくなるところまで下り、r = 2.05 と 3.2 の間でブラックホールのまわりを回り、燃料がなくなる前に外へ出てください。
    そこでは、外向きの噴射は長くは役に立ちません。役に立つのは、軌道に沿った速さです。
mission-05-the-last-orbit-goal-1 = r = 3 より下へ下りる
mission-05-the-last-orbit-goal-1-hint = 進む向きと逆に少しだけ噴射して減速し、落ちましょう。
mission-05-the-last-orbit-goal-2 = r = 2.05 から 3.2 の間で、一周半回る
mission-05-the-last-orbit-goal-2-hint = 高すぎるときは、減速します。低すぎるときは、早めに、進む向きへ噴射します。
mission-05-the-last-orbit-goal-3 = 外へ出る：r = 7 まで上がる
mission-05-the-last-orbit-goal-3-hint = 進む向きへ全力で噴射します。

mission-06-the-long-shot-title = 回りこむ一発
mission-06-the-long-shot-idea = 弾も、ほかのものと同じように落ちます。だから、ブラックホールを回りこませて撃てます。
mission-06-the-long-shot-brief =
    標的は、ブラックホールの反対側にいます。弾は 0.8 c で飛び、ブラックホールのまわりで曲がり、ほかのものと同じように、おくれて見えます。
    線は、今撃ったら弾がどこを通るかを示します。右の数字は、残りの弾の数です。
mission-06-the-long-shot-goal-1 = 標的に弾を当てる
mission-06-the-long-shot-goal-1-hint = 船首を赤い十字へ向けます。まっすぐでも、ブラックホールを回りこんでもかまいません。右に「命中」と出たら [fire] で撃ちます。[slower] で、ゆっくりねらえます。

mission-07-arrive-young-title = 若いままゴールへ
mission-07-arrive-young-idea = 自分の時計は、深いところほど、また速く飛ぶほど、ゆっくり進みます。
mission-07-arrive-young-brief =
    ブラックホールのまわりの、八つのゲートを通ってください。計るのは、遠くの時計ではなく、あなた自身の時計です。
    低いところを速く飛ぶと、年を取るのがおそくなります。最も短い道が、最も若くいられる道とはかぎりません。
mission-07-arrive-young-goal-1 = すべてのゲートを順番に通る
mission-07-arrive-young-goal-1-hint = 印のついた輪が、次のゲートです。早めに向きを合わせましょう。急には曲がれません。

mission-08-hunted-title = 追われる側
mission-08-hunted-idea = ブラックホールは、身をかくすかげにも、ぐるりと回って勢いよく飛び出す場所にもなります。
mission-08-hunted-brief =
    今度は、あなたが標的です。助けが来るまで、追手の手の届かないところにいてください。
    追手との間にブラックホールをはさみ、下りたり上がったりしましょう。追手はあなたに合わせて動くので、反応がおくれます。
mission-08-hunted-goal-1 = T = 90 まで、r = 20 以内で逃げ切る
mission-08-hunted-goal-1-hint = まっすぐ遠くへ逃げてはいけません。r = 20 の外では、だれも助けてくれません。ブラックホールのまわりを回りましょう。

mission-09-two-of-them-title = 相手は二せき
mission-09-two-of-them-idea = どの軌道も、回ってまた戻ってきます。低い軌道ほど、早く戻ります。
mission-09-two-of-them-brief =
    二せきの標的が、いっしょに出発し、別れていきます。まず一せき、次にもう一せきをつかまえてください。
    あとに回した船は、しばらく遠ざかります。下へ下りれば、あなたのほうが先に一周してきます。
mission-09-two-of-them-goal-1 = 一せき目をつかまえる
mission-09-two-of-them-goal-1-hint = 印は一せき目についています。二せき目は、だれも待ってくれません。
mission-09-two-of-them-goal-2 = 二せき目をつかまえる

mission-10-no-way-back-title = 帰り道はない
mission-10-no-way-back-idea = 事象の地平面の内側では、中心は場所ではなく、必ずやってくる時刻です。残り時間はなくなっていきます。
mission-10-no-way-back-brief =
    標的が、先に落ちていきます。あとを追って事象の地平面をこえ、特異点に着く前につかまえてください。
    r = 1 には、あなたを引きとめるものも、目印もありません。大切なのは、あなた自身の時計だけです。
mission-10-no-way-back-goal-1 = 標的を追って、事象の地平面をこえる
mission-10-no-way-back-goal-1-hint = 落ちてください。着く前に、距離をつめておきましょう。
mission-10-no-way-back-goal-2 = 特異点に着く前に、つかまえる
mission-10-no-way-back-goal-2-hint = 標的へ向けて全力で噴射します。「あとで」はありません。
